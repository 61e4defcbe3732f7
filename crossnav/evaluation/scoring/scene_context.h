// SPDX-License-Identifier: MIT
// A scene with the evaluator's data: mesh, navmesh, ray caster and, per goal name, the true
// instances with their viewpoints (benchmark.md, "Viewpoints and distances"). World frame. Not
// thread-safe: one per worker.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/scoring/floor_parts.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::evaluation {

/// A true instance of a goal.
struct Target {
  int instance = 0;
  std::string name;
  Box3 box;
  std::vector<Vector3d> viewpoints_world;  ///< X(g); empty = cannot be observed
  std::vector<int> floors;                 ///< of the viewpoints, sorted
  /// False if the agent's detection rule confirms it from nowhere (dataset.certificate = detection,
  /// or a file with marks). A STOP at it is a success, but it certifies nothing and no distance
  /// leads to it.
  bool is_confirmable = true;
  /// dataset.certificate = detection: a confirming viewpoint for each floor and part.
  std::vector<Vector3d> confirmed_world;
};

/// Places from which a goal can be observed, over all its confirmable instances.
struct GoalPlaces {
  sim::WalkGoals viewpoints;
  std::map<int, sim::WalkGoals> on_floor;  ///< where stages can be certified, by floor
};

class SceneContext {
 public:
  /// Resolves `scene_id` below `scenes_dir`, reads the scene and builds or loads its navmesh.
  static Result<std::unique_ptr<SceneContext>> Load(const std::filesystem::path& scenes_dir,
                                                    const std::string& scene_id,
                                                    const RunConfig& config);
  /// Context of a scene made in code; its navmesh is built and not cached.
  static Result<std::unique_ptr<SceneContext>> Of(sim::Scene scene, const RunConfig& config);

  /// Takes instances and viewpoints from an episode file that lists viewpoints, keys "<scene
  /// file>_<category>", instead of computing them: X(g) of an ObjectNav file is the file's.
  void UseGoals(const std::map<std::string, std::vector<GoalObject>>& goals_by_category,
                const std::string& scene_id);

  /// Takes the marks of unconfirmable instances from an episode file of edition 2.
  void UseMarks(const std::map<std::string, std::vector<GoalObject>>& goals_by_category,
                const std::string& scene_id);

  /// Takes from an episode file which instances its goals mean that are descriptions ("the red
  /// chair upstairs") or pictures: keys "<scene file>_<goal>". After UseGoals and UseMarks.
  void UseInstanceGoals(const std::map<std::string, std::vector<GoalObject>>& goals_by_category,
                        const std::string& scene_id);

  const sim::Scene& scene() const { return *scene_; }
  const sim::NavMesh& navmesh() const { return *navmesh_; }
  const sim::RayCaster& caster() const { return *caster_; }

  /// Instances of a category, or of a raw name that is no category. Computed once per goal.
  const std::vector<Target>& TargetsOf(const std::string& goal) const;

  /// Places that certify a stage: viewpoints that confirm the target under dataset.certificate =
  /// detection, else all its viewpoints.
  const std::vector<Vector3d>& CertifyingPlacesOf(const Target& target) const {
    return IsByDetection() ? target.confirmed_world : target.viewpoints_world;
  }

  /// The viewpoints of TargetsOf, located on the navmesh. Computed once per goal.
  const GoalPlaces& PlacesOf(const std::string& goal) const;

  /// True if some place of `part` (of Parts), on `floor`, certifies the goal.
  bool IsSeenOnPart(const std::string& goal, int floor, int part) const;

  /// True if a STOP at some place of `part`, on `floor`, is a success under eval.success = box.
  /// Tries all places, once per goal, part and radius.
  bool IsSolvedOnPart(const std::string& goal, int floor, int part, const EvalConfig& eval) const;

  /// Sorted ids of the floors on which a confirmable instance of `goal` can be observed.
  std::vector<int> FloorsOf(const std::string& goal) const;

  /// d*: shortest path from `p_world` to a viewpoint of `goal`; empty without a path.
  std::optional<double> DistanceToGoal(const Vector3d& p_world, const std::string& goal) const;
  /// DistanceToGoal that tolerates a start on a disconnected navmesh sliver (a mesh overlaps itself
  /// in some stacked stairs): from the nearest connected place, plus the straight line to it.
  std::optional<double> DistanceToGoalFromAbout(const Vector3d& p_world,
                                                const std::string& goal) const;

  /// Points of the walkable surface on a 0.2 m grid, by x, y, z: a measure of its area. Computed
  /// once.
  const std::vector<Vector3d>& WalkablePoints() const;

  /// The walkable surface, cut where the floor changes. Computed once.
  const FloorParts& Parts() const;

  /// Floor under a point at most a room's height above it.
  int FloorUnder(const Vector3d& p_world) const;

 private:
  SceneContext() = default;
  /// Of an episode file's objects that have viewpoints.
  std::vector<Target> TargetsIn(const std::vector<GoalObject>& goals) const;
  bool IsByDetection() const { return config_.dataset.certificate == "detection"; }
  /// Places where the detection rule confirms the instance: at most one viewpoint per floor and
  /// part.
  std::vector<Vector3d> ConfirmingPlaces(const sim::SceneInstance& instance,
                                         const std::vector<Vector3d>& viewpoints_world) const;
  static std::unique_ptr<SceneContext> Assemble(std::unique_ptr<sim::Scene> scene,
                                                sim::NavMesh navmesh, const RunConfig& config);

  std::unique_ptr<sim::Scene> scene_;
  std::unique_ptr<sim::NavMesh> navmesh_;
  std::unique_ptr<sim::RayCaster> caster_;
  RunConfig config_;
  std::map<std::string, std::set<int>> not_confirmable_;  // UseMarks: ids by category
  mutable std::map<std::string, std::vector<Target>> targets_;
  mutable std::map<std::string, GoalPlaces> places_;
  mutable std::map<std::string, std::set<std::pair<int, int>>> seen_;  // (floor, part)s
  mutable std::map<std::tuple<std::string, int, int, double>, bool> solved_;
  mutable std::vector<Vector3d> walkable_world_;
  mutable std::unique_ptr<FloorParts> parts_;
};

/// Ids ("<folder>/<file>.glb") of all scenes below `scenes_dir`, sorted.
Result<std::vector<std::string>> ListScenes(const std::filesystem::path& scenes_dir);

/// Checks that the episode fits this scene. kMismatch: it does not fit the navmesh (start off it,
/// goal unreachable), as episodes made on another navmesh may not.
Result<void> CheckPlayable(const SceneContext& context, const Episode& episode);

/// Marks of a file of edition 2 that contradict the detection rule, in words; the context must have
/// dataset.certificate = detection.
std::vector<std::string> CheckMarks(
    const SceneContext& context, const std::string& scene_id,
    const std::map<std::string, std::vector<GoalObject>>& goals_by_category);

/// Fills in floors, certificate, cross_floor_required and first_transition_stage.
void Certify(const SceneContext& context, Episode& episode);

/// Claims of the episode's certificate that do not hold, in words; empty = proven. Tries all places
/// that are reachable without a floor change.
std::vector<std::string> CheckCertificate(const SceneContext& context, const Episode& episode,
                                          const RunConfig& config);

}  // namespace crossnav::evaluation
