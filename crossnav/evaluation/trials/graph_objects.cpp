// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/graph_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <list>
#include <set>
#include <tuple>

#include "crossnav/core/category_table.h"
#include "crossnav/evaluation/trials/true_home.h"
#include "crossnav/policy/claim.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/scenegraph/box_measures.h"
#include "crossnav/scenegraph/build_graph.h"
#include "crossnav/sim/sensing/ground_truth.h"

namespace crossnav::evaluation {
namespace {

using geometry::VoxelKey;
using scenegraph::GraphObject;
using scenegraph::GraphRelation;

constexpr double kSameObject_m = 0.5;   // chosen: half of a small armchair
constexpr int kLeastOfObject_vox = 10;  // as policy.object.min_projected_voxels

bool Counts(const std::string& name) {
  const auto rivals = policy::RivalNames();
  return std::any_of(rivals.begin(), rivals.end(),
                     [&](const char* rival) { return CanonicalName(rival) == name; });
}

/// Pixels and voxels of one instance in a frame.
struct ShownObject {
  sim::SeenInstance seen;
  std::vector<VoxelKey> voxels;
};

std::map<int, ShownObject> ShownIn(const Observation& obs, const InstanceImage& instances,
                                   const std::map<int, std::string>& names,
                                   const geometry::MapConfig& map) {
  std::map<int, ShownObject> shown;
  for (int v = 0; v < instances.height; ++v)
    for (int u = 0; u < instances.width; ++u) {
      const int id = instances.At(u, v);
      if (id == 0 || names.count(id) == 0) continue;
      const float depth_m = obs.depth_m.At(u, v);
      ShownObject& one = shown[id];
      one.seen.Add(u, v, depth_m);
      if (!(depth_m >= map.depth_min_m && depth_m <= map.depth_max_m)) continue;
      const VoxelKey key = geometry::KeyOf(
          obs.T_world_camera * BackProjectPixel(obs.camera, u, v, depth_m), map.voxel_m);
      if (one.voxels.empty() || one.voxels.back() != key) one.voxels.push_back(key);
    }
  for (auto& [id, one] : shown) {
    std::sort(one.voxels.begin(), one.voxels.end());
    one.voxels.erase(std::unique(one.voxels.begin(), one.voxels.end()), one.voxels.end());
  }
  return shown;
}

/// Room of the plan; rooms of one open group share an id; -1 = none.
int PlanRoomOf(const world::HousePlan& plan, const Vector3d& p) {
  int found = -1;
  double best_m = -1e9;
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    const world::Room& room = plan.rooms[i];
    const double floor_m = plan.levels[room.level].floor_m;
    if (floor_m > p.z() + 0.3 || floor_m < best_m) continue;
    for (const world::Rect& rect : room.rects) {
      if (!rect.Contains({p.x(), p.y()})) continue;
      best_m = floor_m;
      found = room.open_group >= 0 ? 100000 + room.open_group : static_cast<int>(i);
    }
  }
  return found;
}

/// Storey of a point, from 0: levels less than 1.5 m apart are one.
int PlanFloorOf(const world::HousePlan& plan, const Vector3d& p) {
  constexpr double kStorey_m = 1.5, kUnderFloor_m = 0.3;  // as sim::Floor; as PlanRoomOf
  int floor = -1;
  double base_m = 0;
  for (const world::Level& level : plan.levels) {
    if (level.floor_m > p.z() + kUnderFloor_m) break;
    if (floor >= 0 && level.floor_m - base_m < kStorey_m) continue;
    ++floor;
    base_m = level.floor_m;
  }
  return std::max(0, floor);
}

/// The graph that the scene itself would make.
scenegraph::SceneGraph TrueObjects(const ObjectSurvey& survey, const sim::Scene& scene,
                                   const world::HousePlan& plan) {
  scenegraph::SceneGraph truth;
  for (const auto& [id, named] : survey.seen()) {
    if (named.second < 2) continue;
    const sim::SceneInstance& instance = *scene.FindInstance(id);
    GraphObject object;
    object.id = static_cast<int>(truth.objects.size());
    object.category = named.first;
    object.box = instance.box;
    object.p_center_world = instance.box.Center();
    object.floor = PlanFloorOf(plan, object.p_center_world);
    object.room = PlanRoomOf(plan, object.p_center_world);
    truth.objects.push_back(std::move(object));
  }
  RelateObjects(truth);
  return truth;
}

/// For each true object the found one, -1 = none.
std::vector<int> Match(const scenegraph::SceneGraph& truth, const scenegraph::SceneGraph& graph) {
  std::vector<std::tuple<double, int, int>> pairs;
  for (const GraphObject& a : truth.objects)
    for (const GraphObject& b : graph.objects) {
      const double away_m = (a.box.Center() - b.box.Center()).norm();
      if (a.category == b.category && away_m <= kSameObject_m)
        pairs.emplace_back(away_m, a.id, b.id);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> found(truth.objects.size(), -1);
  std::set<int> used;
  for (const auto& [away_m, a, b] : pairs)
    if (found[a] < 0 && used.insert(b).second) found[a] = b;
  return found;
}

using Relations = std::set<std::tuple<scenegraph::RelationKind, int, int>>;

void Insert(scenegraph::RelationKind kind, int from, int to, Relations& relations) {
  const bool is_symmetric =
      kind == scenegraph::RelationKind::kNextTo || kind == scenegraph::RelationKind::kNear;
  if (is_symmetric && from > to) std::swap(from, to);
  relations.emplace(kind, from, to);
}

/// Measures on which the relation of a pair depends.
std::string PairText(const GraphObject& a, const GraphObject& b) {
  return fmt::format("gap {:.2f} m, height of a over b {:.2f} m, cover {:.2f}, room {} and {}",
                     scenegraph::GapOf(a.box, b.box), a.box.min.z() - b.box.max.z(),
                     scenegraph::CoverOf(a.box, b.box), a.room.value_or(-1), b.room.value_or(-1));
}

/// The relations of `these` that `others` lacks, with the measures in truth and in the graph.
struct FailureTexts {
  const scenegraph::SceneGraph& truth;
  const scenegraph::SceneGraph& graph;
  std::map<int, int> true_of;  // true object of each found one

  void Add(const char* what, const Relations& these, const Relations& others,
           std::vector<std::string>& texts) const {
    for (const auto& relation : these) {
      if (others.count(relation) > 0) continue;
      const auto& [kind, from, to] = relation;
      const GraphObject &a = graph.objects[from], &b = graph.objects[to];
      texts.push_back(fmt::format(
          "{}: {} {} {} {} {}; true {}; found {}", what, a.category, a.id, NameOf(kind), b.category,
          b.id, PairText(truth.objects[true_of.at(from)], truth.objects[true_of.at(to)]),
          PairText(a, b)));
    }
  }
};

}  // namespace

ObjectScore& ObjectScore::operator+=(const ObjectScore& other) {
  objects += other.objects, objects_found += other.objects_found;
  objects_wrong += other.objects_wrong;
  relations += other.relations, relations_found += other.relations_found;
  relations_wrong += other.relations_wrong;
  failures.insert(failures.end(), other.failures.begin(), other.failures.end());
  return *this;
}

ObjectSurvey::ObjectSurvey(const SceneContext& context, const RunConfig& config,
                           perception::PerceptionSuite* suite)
    : context_(context), config_(config), suite_(suite), book_(config.agent.map.voxel_m) {
  for (const sim::SceneInstance& instance : context_.scene().instances)
    if (const std::string name = NameOf(instance); Counts(name)) names_[instance.id] = name;
  if (suite_ != nullptr)
    for (const char* name : policy::RivalNames()) detectable_.insert(CanonicalName(name));
}

void ObjectSurvey::Note(const std::vector<objects::SeenObject>& seen, const Observation& obs) {
  const auto start = std::chrono::steady_clock::now();
  const objects::Moment when{0, views_++};
  book_.Note(seen, obs, when);
  (void)book_.Doubt({}, obs, when);
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Records of the suite's detections. Names without a class are not asked for again.
Result<void> ObjectSurvey::Detect(const Observation& obs) {
  const policy::ObjectConfig& object = config_.agent.policy.object;
  std::vector<objects::SeenObject> seen;
  std::list<perception::Detection> kept;  // masks that `seen` points to
  for (auto name = detectable_.begin(); name != detectable_.end();) {
    auto found = suite_->detector->Detect(obs, *name);
    if (!found && found.error().code == ErrorCode::kUnsupported) {
      name = detectable_.erase(name);
      continue;
    }
    if (!found) return tl::unexpected(found.error());
    for (perception::Detection& detection : *found) {
      if (detection.confidence < object.detector_confidence) continue;
      if (auto ok = suite_->segmenter->Segment(obs, detection); !ok) return ok;
      const auto lifted = policy::LiftDetections({detection}, obs, config_.agent.map, object,
                                                 object.detector_confidence);
      if (lifted.empty()) continue;
      const perception::PixelBox box = detection.box;
      kept.push_back(std::move(detection));
      seen.push_back({*name,
                      lifted.front().voxels,
                      lifted.front().confidence,
                      &kept.back().mask,
                      {box.u0, box.v0, box.u1, box.v1}});
    }
    ++name;
  }
  std::erase_if(names_, [&](const auto& entry) { return !detectable_.contains(entry.second); });
  Note(seen, obs);
  return {};
}

Result<void> ObjectSurvey::Look(const Observation& obs, const sim::Simulator& simulator) {
  if (suite_ != nullptr)
    if (auto ok = Detect(obs); !ok) return ok;
  std::vector<objects::SeenObject> seen;
  for (auto& [id, shown] :
       ShownIn(obs, simulator.last_frame().instance, names_, config_.agent.map)) {
    const auto detection = sim::DetectionOf(shown.seen, simulator.sensor(), config_.ground_truth);
    if (!detection || static_cast<int>(shown.voxels.size()) < kLeastOfObject_vox) continue;
    if (detection->confidence < config_.agent.policy.object.secondary_confidence) continue;
    auto& named = seen_[id];
    named.first = names_.at(id);
    ++named.second;
    seen.push_back({named.first, std::move(shown.voxels), detection->confidence, nullptr, {}});
  }
  if (suite_ == nullptr) Note(seen, obs);
  return {};
}

ObjectScore ScoreObjects(const scenegraph::SceneGraph& graph, const ObjectSurvey& survey,
                         const sim::Scene& scene, const world::HousePlan& plan) {
  const scenegraph::SceneGraph truth = TrueObjects(survey, scene, plan);
  const std::vector<int> found = Match(truth, graph);
  ObjectScore score;
  score.objects = static_cast<int>(truth.objects.size());
  score.objects_found = static_cast<int>(
      std::count_if(found.begin(), found.end(), [](int object) { return object >= 0; }));
  score.objects_wrong = static_cast<int>(graph.objects.size()) - score.objects_found;
  Relations wanted, have;
  for (const GraphRelation& relation : truth.relations)
    if (found[relation.from] >= 0 && found[relation.to] >= 0)
      Insert(relation.kind, found[relation.from], found[relation.to], wanted);
  const std::set<int> ends(found.begin(), found.end());
  for (const GraphRelation& relation : graph.relations)
    if (ends.count(relation.from) > 0 && ends.count(relation.to) > 0)
      Insert(relation.kind, relation.from, relation.to, have);
  score.relations = static_cast<int>(wanted.size());
  for (const auto& relation : wanted) score.relations_found += have.count(relation) > 0 ? 1 : 0;
  for (const auto& relation : have) score.relations_wrong += wanted.count(relation) > 0 ? 0 : 1;
  FailureTexts texts{truth, graph, {}};
  for (std::size_t i = 0; i < found.size(); ++i) texts.true_of[found[i]] = static_cast<int>(i);
  texts.Add("missed", wanted, have, score.failures);
  texts.Add("wrong", have, wanted, score.failures);
  return score;
}

}  // namespace crossnav::evaluation
