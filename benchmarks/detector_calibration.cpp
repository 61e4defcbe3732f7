// SPDX-License-Identifier: MIT
// How often a detector's score is right, and what several views of one thing say together
// (crossnav/policy/view_evidence.h): houses are looked at from covering points, each sighting is
// held against the objects that are there. Usage:
//   detector_calibration NETWORKS_DIR [--second CARD] [--noise PROFILE] HOUSE_FOLDER...
// --second: of the pair with networks.second_detector. --noise: depth and colour of that profile.
// Prints a reliability diagram of the score, the section [evidence] of a card (EvidenceConfig), and
// diagrams of things after one and after several views. The first half of the houses fits, the
// second half is judged; the last lines are the fit of all, and verify.contradiction: what the
// memory's better answer to another name says beside the views.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "covering_points.h"
#include "crossnav/core/categories.h"
#include "crossnav/core/category_table.h"
#include "crossnav/geometry/voxel_map.h"
#include "crossnav/inference/suite.h"
#include "crossnav/memory/semantic_memory.h"
#include "crossnav/policy/claim.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/sensor_noise.h"
#include "crossnav/sim/sensing/simulator.h"
#include "sighting_truth.h"

namespace {

using namespace crossnav;  // NOLINT: a program, not a header
namespace fs = std::filesystem;

constexpr double kSpacing_m = 1.6;  // between the places from which a house is seen
constexpr int kSide_px = 320;
constexpr double kLeastScore = 0.2;
constexpr double kHint = 0.5;   // least score of a thing
constexpr double kClaim = 0.7;  // and of the view that claims it
constexpr std::size_t kMostViews = 4;
constexpr int kMostPoints = 90;

struct Scored {
  double score = 0;
  bool is_true = false;
};

/// Claimed object, with the scores of each view; 0 where it was missed in plain sight.
struct Thing {
  policy::LivePoi poi;
  policy::ClaimTracker book;
  double margin = 0;  ///< cosine of the memory by which the goal answers better than other names
  bool is_true = false;
};

/// Evidence for a thing after some views of it.
struct Case {
  policy::ViewSummary views;
  double margin = 0;
  bool is_true = false;
};

struct House {
  std::vector<Scored> sightings;
  std::vector<Case> cases;
};

/// A view of the policy: another angle is not asked for, because things are looked at from points
/// of a grid.
policy::VerifyConfig Separate() {
  policy::VerifyConfig config;
  config.view_angle_deg = 0;
  return config;
}

/// Its thing, new if there is none yet.
void NoteThing(const policy::Sighting& sighting, bool is_true, std::vector<Thing>& things) {
  auto it = std::find_if(things.begin(), things.end(), [&](const Thing& thing) {
    return policy::IsSameObject(thing.poi.voxels, thing.poi.p_center_world, sighting.voxels,
                                sighting.p_center_world, policy::ObjectConfig{}.merge_distance_m);
  });
  if (it == things.end()) {
    it = things.insert(it, Thing{});
    it->poi.voxels = sighting.voxels;
    it->poi.p_center_world = sighting.p_center_world;
  }
  it->is_true = it->is_true || is_true;
}

/// After one view that claims the thing, and after one to three more: `first` and its successors.
std::vector<Case> CasesOf(const Thing& thing, std::string_view goal) {
  std::vector<Case> cases;
  const policy::ClaimViews* seen = thing.book.ViewsOf(thing.poi.id);
  if (!seen) return cases;
  const auto& views = seen->scores;
  for (std::size_t first = 0; first < views.size(); ++first) {
    if (views[first].Mean() < kClaim) continue;
    for (std::size_t n = 1; n <= std::min(kMostViews, views.size()); ++n) {
      std::vector<policy::ViewScore> some;
      for (std::size_t i = 0; i < n; ++i) some.push_back(views[(first + i) % views.size()]);
      cases.push_back({policy::SummaryOf(some, goal, policy::EvidenceConfig{}.discount),
                       thing.margin, thing.is_true});
    }
  }
  return cases;
}

using Sights = std::array<std::vector<policy::Sighting>, kCategories.size()>;

Result<Sights> SightsOf(const Observation& obs, perception::PerceptionSuite& suite) {
  Sights sights;
  for (std::size_t g = 0; g < kCategories.size(); ++g) {
    auto found = suite.detector->Detect(obs, kCategories[g]);
    if (!found) return tl::unexpected(found.error());
    for (auto& detection : *found)
      if (auto ok = suite.segmenter->Segment(obs, detection); !ok)
        return tl::unexpected(ok.error());
    sights[g] = policy::LiftDetections(*found, obs, {}, {}, kLeastScore);
  }
  return sights;
}

/// The semantic memory after all frames of a house.
struct Memory {
  geometry::VoxelMap map{geometry::MapConfig{}};
  memory::SemanticMemory features{memory::FusionConfig{}, geometry::MapConfig{}.voxel_m};

  Result<void> Add(const Observation& obs, perception::DenseEncoder& encoder) {
    const auto grid = encoder.EncodeImage(obs);
    if (!grid) return tl::unexpected(grid.error());
    const auto& ends = map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    features.FuseRuns(ends.runs(), obs.depth_m, obs.camera, obs.T_world_camera,
                      {grid->rows, grid->cols, grid->dim, grid->data});
    return {};
  }
};

/// As the agent asks it (agent/claims.cpp); 0 where it has no opinion.
double MarginOf(const Memory& memory, const Thing& thing, std::string_view goal,
                const std::vector<policy::NamedText>& names) {
  std::vector<float> text;
  std::vector<policy::NamedText> others;
  for (const policy::NamedText& name : names)
    if (CanonicalName(name.name) == CanonicalName(goal))
      text = name.vector;
    else
      others.push_back(name);
  const auto opinion = policy::OpinionOf(memory.features, thing.poi.voxels, text, others);
  const bool is_of_thing =
      opinion && !policy::IsOfSurroundings(memory.features, thing.poi.voxels,
                                           geometry::MapConfig{}.voxel_m, *opinion, others);
  return is_of_thing ? opinion->Margin() : 0;
}

/// The frame from a pose, the same each time.
Observation ObserveFrom(sim::Simulator& simulator, const sim::NoiseConfig& noise,
                        std::uint64_t seed) {
  Observation obs = simulator.Observe();
  if (noise.profile == "none") return obs;
  const DepthImage perfect_m = obs.depth_m;
  obs.depth_m = sim::NoisyDepth(noise, perfect_m, seed, {obs.camera, &obs.rgb, nullptr, nullptr});
  obs.rgb = sim::NoisyColour(noise, obs.rgb, seed);
  return obs;
}

Result<House> Look(const fs::path& folder, perception::PerceptionSuite& suite,
                   const sim::NoiseConfig& noise) {
  const auto scene = sim::LoadScene(folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(*scene);
  SensorConfig sensor;
  sensor.width_px = sensor.height_px = kSide_px;
  sim::Simulator simulator(*scene, *navmesh, caster, sensor, {});
  const double voxel_m = geometry::MapConfig{}.voxel_m;
  std::vector<AgentPose> poses = LooksFrom(CoveringPoints(*navmesh, kSpacing_m, kMostPoints));
  std::erase_if(poses, [&](const AgentPose& pose) { return !simulator.Reset(pose).has_value(); });
  House house;
  std::array<std::vector<Thing>, kCategories.size()> things;
  std::vector<Sights> seen;
  Memory memory;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!simulator.Reset(poses[i])) continue;
    const Observation obs = ObserveFrom(simulator, noise, i);
    auto sights = SightsOf(obs, suite);
    if (!sights) return tl::unexpected(sights.error());
    if (auto ok = memory.Add(obs, *suite.encoder); !ok) return tl::unexpected(ok.error());
    for (std::size_t g = 0; g < kCategories.size(); ++g)
      for (const policy::Sighting& sighting : (*sights)[g]) {
        const bool is_true = IsThere(sighting, kCategories[g], *scene, voxel_m);
        house.sightings.push_back({sighting.confidence, is_true});
        if (sighting.confidence >= kHint) NoteThing(sighting, is_true, things[g]);
      }
    seen.push_back(std::move(*sights));
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!simulator.Reset(poses[i])) continue;
    const Observation obs = ObserveFrom(simulator, noise, i);
    for (std::size_t g = 0; g < kCategories.size(); ++g)
      for (Thing& thing : things[g])
        policy::NoteScores({thing.poi}, seen[i][g], obs, voxel_m, {}, Separate(), &thing.book);
  }
  std::vector<policy::NamedText> names;
  for (const char* name : policy::RivalNames())
    if (auto text = suite.encoder->EncodeText(name)) names.push_back({name, std::move(*text)});
  for (std::size_t g = 0; g < kCategories.size(); ++g)
    for (Thing& thing : things[g]) {
      thing.margin = MarginOf(memory, thing, kCategories[g], names);
      const auto cases = CasesOf(thing, kCategories[g]);
      house.cases.insert(house.cases.end(), cases.begin(), cases.end());
    }
  return house;
}

/// Numbers of `verify.*` by Newton's method on the likelihood of the log-odds.
policy::EvidenceConfig Fit(const std::vector<Case>& all) {
  using Row = Eigen::Matrix<double, 5, 1>;
  // chosen: cases of one thing repeat each other, and few things are too short
  const Row prior = (Row() << 0.01, 0.01, 0.01, 0.01, 2).finished();
  Row fit = Row::Zero();
  const auto row = [](const Case& c) {
    Row x;
    x << 1, c.views.best_log_odds, c.views.others * (1 - c.views.mean),
        c.views.others * c.views.mean, c.views.shortness;
    return x;
  };
  for (int i = 0; i < 50; ++i) {
    Row slope = -prior.cwiseProduct(fit);
    Eigen::Matrix<double, 5, 5> curve = prior.asDiagonal();
    for (const Case& c : all) {
      const Row x = row(c);
      const double p = 1 / (1 + std::exp(-fit.dot(x)));
      slope += ((c.is_true ? 1 : 0) - p) * x;
      curve += p * (1 - p) * x * x.transpose();
    }
    fit += curve.ldlt().solve(slope);
  }
  policy::EvidenceConfig config;
  config.offset = fit[0];
  config.slope = fit[1];
  config.missed = fit[2];
  config.found = fit[3];
  config.too_short = fit[4];
  return config;
}

/// `verify.contradiction`, and its standard error: by Newton's method, with the evidence of the
/// views as it was fitted.
std::pair<double, double> FitContradiction(const std::vector<Case>& all,
                                           const policy::EvidenceConfig& views) {
  double weight = 0, curve = 0;
  for (int i = 0; i < 50; ++i) {
    double slope = 0;
    curve = 1e-3;
    for (const Case& c : all) {
      const double x = std::min(0.0, c.margin);
      const double log_odds = policy::LogOddsOf(policy::ProbabilityOf(c.views, views)) + weight * x;
      const double p = 1 / (1 + std::exp(-log_odds));
      slope += ((c.is_true ? 1 : 0) - p) * x;
      curve += p * (1 - p) * x * x;
    }
    weight += std::clamp(slope / curve, -2.0, 2.0);
  }
  return {weight, 1 / std::sqrt(curve)};
}

/// Share of true things by the memory's margin, beside the share that their views expect.
void PrintMargins(const std::vector<Case>& all, const policy::EvidenceConfig& views) {
  std::printf("things by the memory's margin\n  margin            n   by views   true\n");
  constexpr std::array kEdges = {-2.0, -0.8, -0.6, -0.4, -0.2, -0.1, 0.0, 2.0};
  for (std::size_t i = 0; i + 1 < kEdges.size(); ++i) {
    double n = 0, said = 0, hits = 0;
    for (const Case& c : all) {
      if (c.margin < kEdges[i] || c.margin >= kEdges[i + 1]) continue;
      n += 1, said += policy::ProbabilityOf(c.views, views), hits += c.is_true ? 1 : 0;
    }
    if (n > 0)
      std::printf("  %4.1f to %4.1f %6.0f   %8.2f   %.2f\n", kEdges[i], kEdges[i + 1], n, said / n,
                  hits / n);
  }
}

/// Probabilities of the cases after one view, or of the others.
std::vector<Scored> Said(const std::vector<Case>& all, const policy::EvidenceConfig& fit,
                         bool is_single) {
  std::vector<Scored> said;
  for (const Case& c : all)
    if ((c.views.others == 0) == is_single)
      said.push_back({policy::ProbabilityOf(c.views, fit), c.is_true});
  return said;
}

/// Reliability diagram, error of the expected share, Brier score and log loss of `all`.
void PrintDiagram(const char* title, const std::vector<Scored>& all) {
  std::printf("%s: %zu\n  said          n   true\n", title, all.size());
  double brier = 0, loss = 0, off = 0;
  for (int bin = 0; bin < 10; ++bin) {
    double n = 0, hits = 0, said = 0;
    for (const Scored& s : all) {
      if (std::min(9, static_cast<int>(s.score * 10)) != bin) continue;
      const double y = s.is_true ? 1 : 0, p = std::clamp(s.score, 0.001, 0.999);
      n += 1, hits += y, said += s.score;
      brier += (s.score - y) * (s.score - y);
      loss -= y * std::log(p) + (1 - y) * std::log(1 - p);
    }
    if (n == 0) continue;
    std::printf("  %.1f to %.1f %4.0f   %.2f\n", bin / 10.0, bin / 10.0 + 0.1, n, hits / n);
    off += std::abs(hits - said);
  }
  const auto n = std::max<double>(1, static_cast<double>(all.size()));
  std::printf("  calibration error %.3f, Brier score %.3f, log loss %.3f\n", off / n, brier / n,
              loss / n);
}

}  // namespace

int main(int argc, char** argv) {
  inference::NetworksConfig config;
  sim::NoiseConfig noise;
  int first = 2;
  for (; first + 1 < argc && std::string_view(argv[first]).starts_with("--"); first += 2) {
    if (std::string_view(argv[first]) == "--second") {
      config.second_detector = argv[first + 1];
      config.second_every = 1;
    } else if (std::string_view(argv[first]) == "--noise") {
      noise = sim::NoiseOfProfile(argv[first + 1]);
    } else {
      return std::fprintf(stderr, "%s is unknown\n", argv[first]), 2;
    }
  }
  if (argc < first + 2)
    return std::fprintf(stderr, "NETWORKS_DIR [--second CARD] and two HOUSE_FOLDERs or more\n"), 2;
  auto set = inference::NetworkSet::Read(config, argv[1]);
  auto suite = set ? set->MakeSuite(SensorConfig{}.camera_height_m)
                   : Result<perception::PerceptionSuite>(tl::unexpected(set.error()));
  if (!suite) return std::fprintf(stderr, "%s\n", suite.error().Message().c_str()), 1;
  std::array<House, 2> halves;
  for (int i = first; i < argc; ++i) {
    auto house = Look(argv[i], *suite, noise);
    if (!house) return std::fprintf(stderr, "%s\n", house.error().Message().c_str()), 1;
    House& half = halves[i - first < (argc - first) / 2 ? 0 : 1];
    std::fprintf(stderr, "%s: %zu sightings\n", argv[i], house->sightings.size());
    half.sightings.insert(half.sightings.end(), house->sightings.begin(), house->sightings.end());
    half.cases.insert(half.cases.end(), house->cases.begin(), house->cases.end());
  }
  PrintDiagram("scores as they are", halves[1].sightings);
  const policy::EvidenceConfig fit = Fit(halves[0].cases);
  std::printf(
      "[evidence]\noffset = %.2f\nslope = %.2f\nmissed = %.2f\nfound = %.2f\ntoo_short = %.2f\n",
      fit.offset, fit.slope, fit.missed, fit.found, fit.too_short);
  PrintDiagram("things after one view, judged half", Said(halves[1].cases, fit, true));
  PrintDiagram("things after two to four views, judged half", Said(halves[1].cases, fit, false));
  std::vector<Case> both = halves[0].cases;
  both.insert(both.end(), halves[1].cases.begin(), halves[1].cases.end());
  const policy::EvidenceConfig all = Fit(both);
  std::printf(
      "all houses: offset = %.2f, slope = %.2f, missed = %.2f, found = %.2f, too_short = %.2f\n",
      all.offset, all.slope, all.missed, all.found, all.too_short);
  PrintMargins(both, all);
  const auto [weight, error] = FitContradiction(both, all);
  std::printf("contradiction = %.1f, standard error %.1f (cases of one thing repeat each other)\n",
              weight, error);
  return 0;
}
