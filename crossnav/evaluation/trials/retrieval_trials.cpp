// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/retrieval_trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

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
constexpr std::size_t kPart = 8;    // chosen: places, about three rooms
constexpr double kFloorWeight = 4;  // chosen
constexpr double kRight = 0.85;     // chosen: of the verdicts of a calibrated encoder
constexpr double kSteps = 200;      // chosen: matches that are tried
constexpr int kLeastQueries = 10;   // chosen: of each kind, for a threshold

std::string SpacedNameOf(const sim::SceneInstance& instance) {
  return SpacedName(instance.category.empty() ? instance.name : instance.category);
}

/// Another floor is far.
double FarFrom(const Vector3d& a, const Vector3d& b) {
  return (a - b).head<2>().norm() + kFloorWeight * std::abs(a.z() - b.z());
}

/// Points that cover the navmesh, no two nearer than kSpacing_m; neighbours follow each other.
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
  for (std::size_t i = 0; i + 1 < kept.size(); ++i)
    std::iter_swap(kept.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                   std::min_element(kept.begin() + static_cast<std::ptrdiff_t>(i) + 1, kept.end(),
                                    [&](const Vector3d& a, const Vector3d& b) {
                                      return FarFrom(a, kept[i]) < FarFrom(b, kept[i]);
                                    }));
  return kept;
}

Result<void> SeeFrom(std::span<const Vector3d> places, sim::Simulator& simulator,
                     perception::DenseEncoder& encoder, memory::SemanticMemory& memory) {
  geometry::VoxelMap map;
  for (const Vector3d& p : places) {
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
    if (voxels == 0) continue;
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

/// Adds what a memory of the views from `places` answers; counts its places if it `is_whole`.
Result<void> Ask(const sim::Scene& scene, std::span<const Vector3d> places,
                 const std::set<std::string>& words, const std::vector<RetrievalChoice>& choices,
                 sim::Simulator& simulator, perception::DenseEncoder& encoder, bool is_whole,
                 RetrievalTrial& trial) {
  memory::SemanticMemory memory;
  if (auto ok = SeeFrom(places, simulator, encoder, memory); !ok) return ok;
  const auto seen = SeenNames(scene, memory);
  for (const std::string& word : words) {
    const auto text = encoder.EncodeText(word);
    if (!text) continue;
    const auto found = seen.find(word);
    const int voxels = found == seen.end() ? 0 : found->second;
    const bool is_there = voxels >= kLeastVoxels;
    const bool is_doubtful = voxels > 0 || NearestName(encoder, *text, seen) > kSameWord;
    if (!is_there && is_doubtful) continue;
    RetrievalQuery query{scene.id, word, is_there, {}};
    for (std::size_t i = 0; i < choices.size(); ++i) {
      memory::QueryConfig config;
      config.min_similarity = choices[i].min_similarity;
      config.min_z_score = choices[i].min_z_score;
      config.min_peak_share = choices[i].min_peak_share;
      const auto answer = memory::Query(memory, *text, config);
      query.match.push_back(memory::MatchOf(memory, *text, answer).best);
      if (is_whole) trial.counts[i] += CountPlaces(scene, word, is_there, answer);
    }
    trial.queries.push_back(std::move(query));
  }
  return {};
}

double Share(int part, int all) {
  return all > 0 ? static_cast<double>(part) / all : 0;
}

/// Share of right verdicts, were as many words there as not.
double RightAtEvenOdds(int right, int asked, int wrong, int wrongly_asked) {
  const double yes = Share(right, asked), no = Share(wrong, wrongly_asked);
  return yes > 0 ? yes / (yes + no) : 0;
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
  RetrievalTrial trial;
  trial.counts.resize(choices.size());
  const std::vector<Vector3d> points = CoveringPoints(*navmesh);
  const std::span<const Vector3d> all = points;
  if (auto ok = Ask(scene, all, words, choices, simulator, encoder, true, trial); !ok)
    return tl::unexpected(ok.error());
  for (std::size_t from = 0; all.size() > kPart && from < all.size(); from += kPart) {
    const auto part = all.subspan(from, std::min(kPart, all.size() - from));
    if (auto ok = Ask(scene, part, words, choices, simulator, encoder, false, trial); !ok)
      return tl::unexpected(ok.error());
  }
  return trial;
}

double PresenceVerdicts::PresentIsRight() const {
  return RightAtEvenOdds(there.present, there.asked, not_there.present, not_there.asked);
}

double PresenceVerdicts::AbsentIsRight() const {
  return RightAtEvenOdds(not_there.absent, not_there.asked, there.absent, there.asked);
}

PresenceVerdicts CountVerdicts(const std::vector<RetrievalQuery>& queries, std::size_t choice,
                               const memory::MatchThresholds& thresholds) {
  PresenceVerdicts counted{thresholds, {}, {}};
  for (const RetrievalQuery& query : queries) {
    VerdictCount& count = query.is_there ? counted.there : counted.not_there;
    const auto verdict = memory::Judge({0, query.match[choice], {}}, thresholds);
    count.asked += 1;
    count.present += verdict == memory::Verdict::kPresent;
    count.absent += verdict == memory::Verdict::kAbsent;
  }
  return counted;
}

std::optional<PresenceVerdicts> ChoosePresence(const std::vector<RetrievalQuery>& queries,
                                               std::size_t choice) {
  const auto at = [&](int step) {
    const double match = step / kSteps;
    return CountVerdicts(queries, choice, {match, match});
  };
  const PresenceVerdicts first = at(1);
  if (first.there.asked < kLeastQueries || first.not_there.asked < kLeastQueries) return {};
  int present_from = 0, absent_below = 0, between = 1;
  double least_errors = 2;
  for (int step = 1; step <= kSteps; ++step) {
    const PresenceVerdicts one = at(step);
    if (present_from == 0 && one.PresentIsRight() >= kRight) present_from = step;
    if (one.AbsentIsRight() >= kRight) absent_below = step;
    const double errors = Share(one.there.absent, one.there.asked) +
                          Share(one.not_there.present, one.not_there.asked);
    if (errors < least_errors) {
      least_errors = errors;
      between = step;
    }
  }
  if (present_from == 0 || absent_below == 0) return {};
  if (absent_below >= present_from) return at(between);
  return CountVerdicts(queries, choice, {absent_below / kSteps, present_from / kSteps});
}

std::size_t BestChoice(const std::vector<RetrievalCount>& counts) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < counts.size(); ++i)
    if (counts[i].F1() > counts[best].F1()) best = i;
  return best;
}

}  // namespace crossnav::evaluation
