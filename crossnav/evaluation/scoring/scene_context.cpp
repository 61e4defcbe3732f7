// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/scoring/scene_context.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "crossnav/core/categories.h"
#include "crossnav/evaluation/records/goal_kind.h"
#include "crossnav/evaluation/scoring/confirmation.h"
#include "crossnav/evaluation/scoring/outcome.h"
#include "crossnav/evaluation/scoring/viewpoint_cache.h"

namespace crossnav::evaluation {
namespace {

bool EndsWith(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The scene's instance for a goal of a file: by its id, else by its place.
const sim::SceneInstance* InstanceOf(const sim::Scene& scene, const GoalObject& goal) {
  constexpr double kAt_m = 0.3;  // chosen: files give centres, with a few decimals
  const auto holds = [&](const sim::SceneInstance& instance) {
    return instance.box.HorizontalDistance(goal.p_world) < kAt_m &&
           goal.p_world.z() > instance.box.min.z() - kAt_m &&
           goal.p_world.z() < instance.box.max.z() + kAt_m;
  };
  const sim::SceneInstance* same = scene.FindInstance(goal.object_id);
  if (same != nullptr && holds(*same)) return same;
  for (const sim::SceneInstance& instance : scene.instances) {
    if (instance.category == goal.category && holds(instance)) return &instance;
  }
  return nullptr;
}

std::vector<int> FloorsUnder(const sim::NavMesh& navmesh, const std::vector<Vector3d>& points) {
  std::set<int> floors;
  for (const Vector3d& p : points) floors.insert(navmesh.FloorOf(p));
  return {floors.begin(), floors.end()};
}

}  // namespace

Result<std::unique_ptr<SceneContext>> SceneContext::Load(const std::filesystem::path& scenes_dir,
                                                         const std::string& scene_id,
                                                         const RunConfig& config) {
  const auto folder = sim::FindScene(scenes_dir, scene_id);
  if (!folder) return tl::unexpected(folder.error());
  auto scene = sim::LoadScene(*folder);
  if (!scene) return tl::unexpected(scene.error());
  auto owned = std::make_unique<sim::Scene>(std::move(*scene));
  auto navmesh = sim::NavMesh::Open(*owned, config.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  return Assemble(std::move(owned), std::move(*navmesh), config);
}

Result<std::unique_ptr<SceneContext>> SceneContext::Of(sim::Scene scene, const RunConfig& config) {
  auto owned = std::make_unique<sim::Scene>(std::move(scene));
  sim::UpdateDerived(*owned);
  auto navmesh = sim::NavMesh::Build(*owned, config.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  return Assemble(std::move(owned), std::move(*navmesh), config);
}

std::unique_ptr<SceneContext> SceneContext::Assemble(std::unique_ptr<sim::Scene> scene,
                                                     sim::NavMesh navmesh,
                                                     const RunConfig& config) {
  std::unique_ptr<SceneContext> context(new SceneContext);
  context->scene_ = std::move(scene);
  context->navmesh_ = std::make_unique<sim::NavMesh>(std::move(navmesh));
  context->caster_ = std::make_unique<sim::RayCaster>(*context->scene_);
  context->config_ = config;
  return context;
}

std::vector<Target> SceneContext::TargetsIn(const std::vector<GoalObject>& goals) const {
  std::vector<Target> targets;
  for (const GoalObject& goal : goals) {
    if (goal.viewpoints_world.empty()) continue;
    const sim::SceneInstance* instance = InstanceOf(*scene_, goal);
    Target target{goal.object_id, goal.name, {}, goal.viewpoints_world, {}, true, {}};
    target.box.Add(goal.p_world);
    if (instance != nullptr) {
      target.instance = instance->id;
      target.box = instance->box;
    }
    target.floors = FloorsUnder(*navmesh_, target.viewpoints_world);
    targets.push_back(std::move(target));
  }
  return targets;
}

void SceneContext::UseGoals(const std::map<std::string, std::vector<GoalObject>>& goals_by_category,
                            const std::string& scene_id) {
  const std::string prefix = std::filesystem::path(scene_id).filename().string() + "_";
  for (const auto& [key, goals] : goals_by_category) {
    if (key.rfind(prefix, 0) != 0) continue;
    auto targets = TargetsIn(goals);
    if (!targets.empty()) targets_[key.substr(prefix.size())] = std::move(targets);
  }
  places_.clear();
  seen_.clear();
  solved_.clear();
}

void SceneContext::UseInstanceGoals(
    const std::map<std::string, std::vector<GoalObject>>& goals_by_category,
    const std::string& scene_id) {
  const std::string prefix = std::filesystem::path(scene_id).filename().string() + "_";
  for (const auto& [key, goals] : goals_by_category) {
    if (key.rfind(prefix, 0) != 0) continue;
    const std::string goal = key.substr(prefix.size());
    if (KindOf(goal) == GoalKind::kCategory) continue;
    auto targets = TargetsIn(goals);
    for (Target& target : targets) {
      const sim::SceneInstance* instance = scene_->FindInstance(target.instance);
      if (!IsByDetection() || instance == nullptr) continue;
      target.confirmed_world = ConfirmingPlaces(*instance, target.viewpoints_world);
      target.is_confirmable = !target.confirmed_world.empty();
    }
    if (!targets.empty()) targets_[goal] = std::move(targets);
  }
}

void SceneContext::UseMarks(const std::map<std::string, std::vector<GoalObject>>& goals_by_category,
                            const std::string& scene_id) {
  const std::string prefix = std::filesystem::path(scene_id).filename().string() + "_";
  for (const auto& [key, goals] : goals_by_category) {
    if (key.rfind(prefix, 0) != 0) continue;
    for (const GoalObject& goal : goals) {
      if (!goal.is_confirmable) not_confirmable_[key.substr(prefix.size())].insert(goal.object_id);
    }
  }
  targets_.clear();
  places_.clear();
  seen_.clear();
  solved_.clear();
}

std::vector<Vector3d> SceneContext::ConfirmingPlaces(
    const sim::SceneInstance& instance, const std::vector<Vector3d>& viewpoints_world) const {
  const ConfirmationRule rule(*caster_, instance, config_);
  std::map<std::pair<int, int>, std::vector<Vector3d>> groups;  // by floor and part
  for (const Vector3d& p : viewpoints_world) {
    const int part = Parts().PartAt(p);
    if (part >= 0) groups[{navmesh_->FloorOf(p), part}].push_back(p);
  }
  std::vector<Vector3d> places;
  for (auto& [floor_and_part, points] : groups) {
    if (const auto place = rule.FirstOf(std::move(points))) places.push_back(*place);
  }
  return places;
}

const std::vector<Target>& SceneContext::TargetsOf(const std::string& goal) const {
  const auto known = targets_.find(goal);
  if (known != targets_.end()) return known->second;
  std::vector<const sim::SceneInstance*> instances;
  for (const sim::SceneInstance& instance : scene_->instances) {
    if ((IsCategory(goal) ? instance.category : instance.name) == goal) {
      instances.push_back(&instance);
    }
  }
  auto viewpoints = ViewpointsOf({*scene_, *navmesh_, *caster_, config_.agent.sensor}, instances);
  std::vector<Target> targets;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const sim::SceneInstance& instance = *instances[i];
    Target target{instance.id, instance.name, instance.box, std::move(viewpoints[i]), {}, true, {}};
    target.floors = FloorsUnder(*navmesh_, target.viewpoints_world);
    if (IsByDetection()) {
      target.confirmed_world = ConfirmingPlaces(instance, target.viewpoints_world);
      target.is_confirmable = !target.confirmed_world.empty();
    } else if (const auto marks = not_confirmable_.find(goal); marks != not_confirmable_.end()) {
      target.is_confirmable = !marks->second.contains(target.instance);
    }
    targets.push_back(std::move(target));
  }
  return targets_.emplace(goal, std::move(targets)).first->second;
}

const GoalPlaces& SceneContext::PlacesOf(const std::string& goal) const {
  const auto known = places_.find(goal);
  if (known != places_.end()) return known->second;
  std::vector<Vector3d> all;
  std::map<int, std::vector<Vector3d>> on_floor;
  GoalPlaces places;
  for (const Target& target : TargetsOf(goal)) {
    if (!target.is_confirmable) continue;
    const auto& certifying = CertifyingPlacesOf(target);
    all.insert(all.end(), target.viewpoints_world.begin(), target.viewpoints_world.end());
    for (const Vector3d& p : certifying) on_floor[navmesh_->FloorOf(p)].push_back(p);
  }
  places.viewpoints = navmesh_->FindGoals(all);
  for (const auto& [floor, points] : on_floor) {
    places.on_floor[floor] = navmesh_->FindGoals(points);
  }
  return places_.emplace(goal, std::move(places)).first->second;
}

bool SceneContext::IsSeenOnPart(const std::string& goal, int floor, int part) const {
  const auto [seen, is_new] = seen_.try_emplace(goal);
  if (is_new) {
    for (const Target& target : TargetsOf(goal)) {
      for (const Vector3d& p : CertifyingPlacesOf(target)) {
        seen->second.emplace(navmesh_->FloorOf(p), Parts().PartAt(p));
      }
    }
  }
  return seen->second.contains({floor, part});
}

bool SceneContext::IsSolvedOnPart(const std::string& goal, int floor, int part,
                                  const EvalConfig& eval) const {
  const std::tuple key(goal, floor, part, eval.success_radius_m);
  const auto known = solved_.find(key);
  if (known != solved_.end()) return known->second;
  std::vector<const Target*> here;
  for (const Target& target : TargetsOf(goal)) {
    if (std::ranges::find(target.floors, floor) != target.floors.end()) here.push_back(&target);
  }
  const bool is_solved = !here.empty() && Parts().AnyPoint(part, [&](const Vector3d& p_world) {
    return std::ranges::any_of(here, [&](const Target* target) {
      return IsWithinBoxRadius(*target, p_world, floor, eval);
    });
  });
  return solved_.emplace(key, is_solved).first->second;
}

std::vector<int> SceneContext::FloorsOf(const std::string& goal) const {
  std::set<int> floors;
  for (const Target& target : TargetsOf(goal)) {
    if (!target.is_confirmable) continue;
    floors.insert(target.floors.begin(), target.floors.end());
  }
  return {floors.begin(), floors.end()};
}

std::optional<double> SceneContext::DistanceToGoal(const Vector3d& p_world,
                                                   const std::string& goal) const {
  return navmesh_->Geodesic(p_world, PlacesOf(goal).viewpoints);
}

std::optional<double> SceneContext::DistanceToGoalFromAbout(const Vector3d& p_world,
                                                            const std::string& goal) const {
  constexpr double kReach_m = 1.0, kRing_m = 0.1, kRise_m = 0.5;  // chosen: a body's size or two
  constexpr int kDirections = 16;
  if (const auto distance_m = DistanceToGoal(p_world, goal)) return distance_m;
  for (double off_m = 0; off_m <= kReach_m; off_m += kRing_m) {
    std::optional<double> nearest_m;
    for (int i = 0; i < kDirections; ++i) {
      const double angle_rad = DegToRad(360.0 * i / kDirections);
      const double x_m = p_world.x() + off_m * std::cos(angle_rad);
      const double y_m = p_world.y() + off_m * std::sin(angle_rad);
      for (const double z_m :
           navmesh_->HeightsAt(x_m, y_m, p_world.z() - kRise_m, p_world.z() + kRise_m)) {
        const Vector3d p_about(x_m, y_m, z_m);
        const auto rest_m = DistanceToGoal(p_about, goal);
        if (rest_m)
          nearest_m = std::min(nearest_m.value_or(1e9), *rest_m + (p_about - p_world).norm());
      }
    }
    if (nearest_m) return nearest_m;
  }
  return std::nullopt;
}

const std::vector<Vector3d>& SceneContext::WalkablePoints() const {
  if (!walkable_world_.empty()) return walkable_world_;
  constexpr double kGrid_m = 0.2;  // chosen: a fifth of a flight's width
  Box3 box;
  for (const auto& triangle : navmesh_->Triangles()) {
    for (const Vector3f& p : triangle.p_world) box.Add(p.cast<double>());
  }
  if (box.empty()) return walkable_world_;
  const auto first = [](double m) { return static_cast<int>(std::ceil(m / kGrid_m)); };
  for (int x = first(box.min.x()); x * kGrid_m <= box.max.x(); ++x) {
    for (int y = first(box.min.y()); y * kGrid_m <= box.max.y(); ++y) {
      const double x_m = x * kGrid_m, y_m = y * kGrid_m;
      for (const double z_m :
           navmesh_->HeightsAt(x_m, y_m, box.min.z() - kGrid_m, box.max.z() + kGrid_m)) {
        walkable_world_.emplace_back(x_m, y_m, z_m);
      }
    }
  }
  return walkable_world_;
}

const FloorParts& SceneContext::Parts() const {
  if (!parts_) parts_ = std::make_unique<FloorParts>(*navmesh_);
  return *parts_;
}

int SceneContext::FloorUnder(const Vector3d& p_world) const {
  constexpr double kSlack_m = 0.3;  // chosen: voxel centres and steps lie a little below a floor
  int under = navmesh_->Floors().empty() ? 0 : navmesh_->Floors().front().id;
  for (const sim::Floor& floor : navmesh_->Floors()) {
    const double lowest_m = floor.levels_m.empty() ? floor.height_m : floor.levels_m.front();
    if (lowest_m <= p_world.z() + kSlack_m) under = floor.id;
  }
  return under;
}

Result<std::vector<std::string>> ListScenes(const std::filesystem::path& scenes_dir) {
  std::error_code error;
  if (!std::filesystem::is_directory(scenes_dir, error)) {
    return Fail(ErrorCode::kNotFound, "no such folder of scenes", scenes_dir.string());
  }
  std::vector<std::string> ids;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scenes_dir, error)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || !EndsWith(name, ".semantic.txt")) continue;
    const std::string stem = name.substr(0, name.size() - std::string(".semantic.txt").size());
    const auto folder = std::filesystem::relative(entry.path().parent_path(), scenes_dir, error);
    ids.push_back((folder / (stem + ".glb")).lexically_normal().string());
  }
  if (ids.empty()) {
    return Fail(ErrorCode::kNotFound, "holds no scene (a folder with NAME.semantic.txt)",
                scenes_dir.string());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

Result<void> CheckPlayable(const SceneContext& context, const Episode& episode) {
  const Vector3d& p = episode.start.p_world;
  if (!p.allFinite() || !std::isfinite(episode.start.yaw_rad)) {
    return Fail(ErrorCode::kInvalid, "the start pose is not finite",
                episode.where + ": start_position");
  }
  const auto start = context.navmesh().Snap(p);
  if (!start) {
    return Fail(ErrorCode::kMismatch, "the start is off the navmesh of " + context.scene().id,
                episode.where + ": start_position");
  }
  for (const std::string& goal : episode.goals) {
    const std::string where = episode.where + ": goals";
    if (context.TargetsOf(goal).empty()) {
      return Fail(ErrorCode::kNotFound, context.scene().id + " has no \"" + goal + "\"", where);
    }
    if (!context.DistanceToGoal(*start, goal)) {
      return Fail(ErrorCode::kMismatch,
                  "no \"" + goal + "\" of " + context.scene().id + " can be reached from the start",
                  where);
    }
  }
  return {};
}

}  // namespace crossnav::evaluation
