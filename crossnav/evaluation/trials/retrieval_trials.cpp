// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/retrieval_trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "crossnav/core/category_table.h"
#include "crossnav/core/rng.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/memory/history_poi.h"
#include "crossnav/memory/query_match.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/sim/navmesh/navmesh.h"
#include "crossnav/sim/render/ray_caster.h"

namespace crossnav::evaluation {
namespace {

constexpr std::array<const char*, 20> kNowhere = {
    "zebra",    "giraffe", "airplane",   "submarine",  "volcano",       "tractor",      "trumpet",
    "banana",   "penguin", "helicopter", "skateboard", "traffic light", "fire hydrant", "surfboard",
    "elephant", "violin",  "canoe",      "tank",       "castle",        "rocket"};
constexpr double kSpacing_m = 2.2;  // chosen: between the places from which a house is seen
constexpr int kMisses = 150;        // chosen: points in a row that are too near, and it is covered
constexpr int kTrialYaws = 5;
constexpr int kSide_px = 240;
constexpr int kLeastVoxels = 5;     // of an instance that was seen
constexpr double kSameWord = 0.9;   // cosine
constexpr double kMargin_m = 0.25;  // chosen: of a place around its instance's box
constexpr double kLeastSeparation = 0.8;
constexpr int kLeastQueries = 10;  // chosen: of each kind, for a threshold

std::string SpacedNameOf(const sim::SceneInstance& instance) {
  return SpacedName(instance.category.empty() ? instance.name : instance.category);
}

/// Points that cover the navmesh, no two nearer than kSpacing_m.
std::vector<Vector3d> CoveringPoints(const sim::NavMesh& navmesh) {
  Rng rng(5);
  std::vector<Vector3d> kept;
  for (int missed = 0; missed < kMisses;) {
    const auto p = navmesh.RandomPoint(rng);
    if (!p) break;
    const bool is_near = std::any_of(
        kept.begin(), kept.end(), [&](const Vector3d& q) { return (q - *p).norm() < kSpacing_m; });
    missed = is_near ? missed + 1 : 0;
    if (!is_near) kept.push_back(*p);
  }
  return kept;
}

Result<void> SeeWhole(const sim::NavMesh& navmesh, sim::Simulator& simulator,
                      perception::DenseEncoder& encoder, memory::SemanticMemory& memory) {
  geometry::VoxelMap map;
  for (const Vector3d& p : CoveringPoints(navmesh)) {
    for (int yaw = 0; yaw < kTrialYaws; ++yaw) {
      if (!simulator.Reset({p, yaw * 2 * M_PI / kTrialYaws, yaw % 2 == 0 ? 0 : DegToRad(-30)}))
        continue;
      const Observation obs = simulator.Observe();
      const auto& pixels = map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
      const auto grid = encoder.EncodeImage(obs);
      if (!grid) return tl::unexpected(grid.error());
      memory.Fuse(pixels, obs.depth_m, obs.camera, obs.T_world_camera,
                  {grid->rows, grid->cols, grid->dim, grid->data});
    }
  }
  return {};
}

bool IsIn(const Vector3d& p, const Box3& box, double margin_m) {
  return (p.array() >= box.min.array() - margin_m).all() &&
         (p.array() <= box.max.array() + margin_m).all();
}

/// Names in the house -> the most voxels that any of its instances has in the memory.
std::map<std::string, int> SeenNames(const sim::Scene& scene,
                                     const memory::SemanticMemory& memory) {
  std::map<std::string, int> seen;
  for (const sim::SceneInstance& instance : scene.instances) {
    const auto keys = memory.Keys();
    const auto voxels = std::count_if(keys.begin(), keys.end(), [&](const auto& key) {
      return IsIn(geometry::CenterOf(key, memory.VoxelSize()), instance.box, 0);
    });
    int& most = seen[SpacedNameOf(instance)];
    most = std::max(most, static_cast<int>(voxels));
  }
  return seen;
}

double NearestName(perception::DenseEncoder& encoder, const std::vector<float>& text,
                   const std::map<std::string, int>& seen) {
  double nearest = -1;
  for (const auto& [name, voxels] : seen) {
    const auto other = encoder.EncodeText(name);
    if (!other) continue;
    nearest = std::max(nearest, std::inner_product(text.begin(), text.end(), other->begin(), 0.0));
  }
  return nearest;
}

RetrievalCount CountPlaces(const sim::Scene& scene, const std::string& word, bool is_there,
                           const std::vector<memory::MemoryCluster>& places) {
  RetrievalCount count;
  count.asked = is_there ? 1 : 0;
  for (const memory::MemoryCluster& place : places) {
    const bool is_right =
        is_there && std::any_of(scene.instances.begin(), scene.instances.end(),
                                [&](const sim::SceneInstance& instance) {
                                  return SpacedNameOf(instance) == word &&
                                         IsIn(place.p_center_world, instance.box, kMargin_m);
                                });
    (is_right ? count.right : count.wrong) += 1;
  }
  count.found = count.right > 0 ? 1 : 0;
  return count;
}

}  // namespace

double RetrievalCount::F1() const {
  if (found == 0) return 0;
  const double recall = static_cast<double>(found) / asked;
  const double precision = static_cast<double>(right) / (right + wrong);
  return 2 * precision * recall / (precision + recall);
}

RetrievalCount& RetrievalCount::operator+=(const RetrievalCount& other) {
  asked += other.asked;
  found += other.found;
  right += other.right;
  wrong += other.wrong;
  return *this;
}

std::vector<RetrievalChoice> RetrievalChoices() {
  const memory::QueryConfig base;
  std::vector<RetrievalChoice> all = {{base.min_similarity, base.min_z_score, base.min_peak_share}};
  for (const double similarity : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6})
    for (const double z_score : {2.0, 3.0, 4.0})
      for (const double share : {0.5, 0.7}) all.push_back({similarity, z_score, share});
  return all;
}

std::set<std::string> WordsOf(const sim::Scene& scene) {
  std::set<std::string> words;
  for (const sim::SceneInstance& instance : scene.instances) words.insert(SpacedNameOf(instance));
  return words;
}

std::set<std::string> WordsOfNoHouse() {
  return {kNowhere.begin(), kNowhere.end()};
}

Result<RetrievalTrial> TryRetrieval(const sim::Scene& scene, const std::set<std::string>& words,
                                    const std::vector<RetrievalChoice>& choices,
                                    const MakeEncoder& make_encoder, const RunConfig& config) {
  const auto navmesh = sim::NavMesh::Build(scene, config.navmesh);
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(scene);
  SensorConfig sensor = config.agent.sensor;
  sensor.width_px = sensor.height_px = kSide_px;
  sim::Simulator simulator(scene, *navmesh, caster, sensor, config.agent.action);
  const auto held = make_encoder(simulator);
  if (!held) return tl::unexpected(held.error());
  perception::DenseEncoder& encoder = *held->encoder;
  memory::SemanticMemory memory;
  if (auto ok = SeeWhole(*navmesh, simulator, encoder, memory); !ok)
    return tl::unexpected(ok.error());
  const auto seen = SeenNames(scene, memory);
  RetrievalTrial trial;
  trial.counts.resize(choices.size());
  for (const std::string& word : words) {
    const auto text = encoder.EncodeText(word);
    if (!text) continue;
    const auto found = seen.find(word);
    const bool is_there = found != seen.end() && found->second >= kLeastVoxels;
    const bool is_doubtful = found != seen.end() || NearestName(encoder, *text, seen) > kSameWord;
    if (!is_there && is_doubtful) continue;
    const auto match = memory::MatchOf(memory, *text, memory::Query(memory, *text, {}));
    trial.queries.push_back({scene.id, word, is_there, match.best});
    for (std::size_t i = 0; i < choices.size(); ++i) {
      memory::QueryConfig query;
      query.min_similarity = choices[i].min_similarity;
      query.min_z_score = choices[i].min_z_score;
      query.min_peak_share = choices[i].min_peak_share;
      trial.counts[i] += CountPlaces(scene, word, is_there, memory::Query(memory, *text, query));
    }
  }
  return trial;
}

PresenceThreshold ChoosePresence(const std::vector<RetrievalQuery>& queries) {
  PresenceThreshold best;
  for (const RetrievalQuery& q : queries) (q.is_there ? best.there : best.not_there) += 1;
  if (best.there < kLeastQueries || best.not_there < kLeastQueries) return best;
  for (int step = 1; step < 100; ++step) {
    const double from = step / 100.0;
    const auto count = [&](bool is_there) {
      return static_cast<int>(std::count_if(
          queries.begin(), queries.end(),
          [&](const RetrievalQuery& q) { return q.is_there == is_there && q.match >= from; }));
    };
    const int found = count(true), falsely = count(false);
    const double separation =
        static_cast<double>(found) / best.there - static_cast<double>(falsely) / best.not_there;
    if (separation <= best.separation) continue;
    best.separation = separation;
    best.found = found;
    best.falsely = falsely;
    best.present_from = from;
  }
  if (best.separation < kLeastSeparation) best.present_from.reset();
  return best;
}

std::size_t BestChoice(const std::vector<RetrievalCount>& counts) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < counts.size(); ++i)
    if (counts[i].F1() > counts[best].F1()) best = i;
  return best;
}

}  // namespace crossnav::evaluation
