// SPDX-License-Identifier: MIT
// Objects of a generated house as ground-truth perception shows them, and the graph's objects and
// relations against the scene's instances. World frame, metres.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "crossnav/evaluation/scoring/scene_context.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/objects/object_book.h"
#include "crossnav/perception/perception.h"
#include "crossnav/scenegraph/scene_graph.h"
#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/world/plan/plan.h"

namespace crossnav::evaluation {

struct ObjectScore {
  int objects = 0, objects_found = 0, objects_wrong = 0;  ///< instances that were seen; records
  int relations = 0, relations_found = 0;  ///< of instances that were found, both ends
  int relations_wrong = 0;                 ///< between found ends, beside the true ones
  std::vector<std::string> failures;       ///< missed and wrong relations with their measures

  double ObjectsF1() const {
    const int all = 2 * objects_found + objects_wrong + (objects - objects_found);
    return all > 0 ? 2.0 * objects_found / all : 0;
  }
  double RelationsRecall() const {
    return relations > 0 ? static_cast<double>(relations_found) / relations : 1;
  }
  ObjectScore& operator+=(const ObjectScore& other);
};

/// Instances by name: of a benchmark's category, and furniture beside them.
class ObjectSurvey {
 public:
  /// Records come from ground truth; with `suite`, from its detector, and only names that it has a
  /// class for count. All must outlive it.
  ObjectSurvey(const SceneContext& context, const RunConfig& config,
               perception::PerceptionSuite* suite = nullptr);

  /// Notes the detections in the simulator's last frame. Error: a failing network.
  Result<void> Look(const Observation& obs, const sim::Simulator& simulator);
  const objects::ObjectBook& book() const { return book_; }
  double seconds() const { return seconds_; }  ///< of the records' work alone
  int views() const { return views_; }
  /// Names and numbers of ground truth's detections, by instance: what there was to see.
  const std::map<int, std::pair<std::string, int>>& seen() const { return seen_; }

 private:
  Result<void> Detect(const Observation& obs);
  void Note(const std::vector<objects::SeenObject>& seen, const Observation& obs);

  const SceneContext& context_;
  const RunConfig& config_;
  perception::PerceptionSuite* suite_;
  std::set<std::string> detectable_;  // names to ask the suite for
  objects::ObjectBook book_;
  std::map<int, std::string> names_;                 // of the instances that count
  std::map<int, std::pair<std::string, int>> seen_;  // name and detections
  double seconds_ = 0;
  int views_ = 0;
};

/// Found objects are within half a metre of their instance's box centre, each once, nearest first.
/// True relations follow from the instances' boxes and the plan's rooms, by the graph's rules.
ObjectScore ScoreObjects(const scenegraph::SceneGraph& graph, const ObjectSurvey& survey,
                         const sim::Scene& scene, const world::HousePlan& plan);

}  // namespace crossnav::evaluation
