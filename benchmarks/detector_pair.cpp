// SPDX-License-Identifier: MIT
// Gain of a second detector over the first alone (crossnav/inference/second_opinion.h): houses are
// looked at from covering points, and each box of either is held against the objects there.
// Usage:
//   detector_pair NETWORKS_DIR SECOND HOUSE_FOLDER... -- HOUSE_FOLDER...
// Fits the section [opinion] of SECOND's card on the first houses and prints it; on the others it
// prints how well the first detector alone and the pair tell true boxes from false ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "covering_points.h"
#include "crossnav/core/categories.h"
#include "crossnav/inference/depth_mask.h"
#include "crossnav/inference/frame_input.h"
#include "crossnav/inference/second_opinion.h"
#include "crossnav/inference/suite.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/sensing/simulator.h"
#include "sighting_truth.h"

namespace {

using namespace crossnav;  // NOLINT: a program, not a header
namespace fs = std::filesystem;
using inference::FoundBox;
using perception::Detection;
using perception::PixelBox;

constexpr double kSpacing_m = 1.6;           // between the places from which a house is seen
constexpr int kSide_px = 320, kMisses = 60;  // kMisses: see CoveringPoints
constexpr std::size_t kGoals = kCategories.size();
constexpr std::size_t kSides = 2 + kGoals;  // of a row: first, difference, unseen by goal

/// A box of one goal.
struct Case {
  std::size_t goal = 0;
  std::optional<double> first;  ///< confidence; nullopt = a box of the second alone
  inference::PairScores second;
  bool is_true = false;
};

struct Detectors {
  perception::PerceptionSuite suite;
  std::shared_ptr<inference::Model> second;
  inference::ModelCard card;
};

/// Cases of one goal in a frame; sightings without a voxel are left out.
Result<void> AddCases(const Observation& obs, std::size_t goal, const std::vector<FoundBox>& boxes,
                      const sim::Scene& scene, Detectors& with, std::vector<Case>& cases) {
  const double voxel_m = geometry::MapConfig{}.voxel_m;
  const auto labels = inference::LabelsOf(kCategories[goal], with.card.labels);
  const auto add = [&](const Detection& detection, Case one) {
    const auto sightings = policy::LiftDetections({detection}, obs, {}, {}, 0.01);
    if (sightings.empty()) return;
    one.is_true = IsThere(sightings[0], kCategories[goal], scene, voxel_m);
    cases.push_back(one);
  };
  auto found = with.suite.detector->Detect(obs, kCategories[goal]);
  if (!found) return tl::unexpected(found.error());
  std::vector<bool> is_taken(boxes.size(), false);
  for (Detection& detection : *found) {
    const auto scores = inference::ScoresAt(detection.box, boxes, labels);
    if (scores.best) is_taken[*scores.best] = true;
    if (auto ok = with.suite.segmenter->Segment(obs, detection); !ok) return ok;
    add(detection, {goal, detection.confidence, scores, false});
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const bool is_goal = std::find(labels.begin(), labels.end(), boxes[i].label) != labels.end();
    if (is_taken[i] || !is_goal || boxes[i].score < inference::kLeastAlone) continue;
    const PixelBox box = inference::Placement{}.ToFrame(boxes[i].left, boxes[i].top, boxes[i].right,
                                                        boxes[i].bottom, kSide_px, kSide_px);
    if (box.Area() <= 0) continue;
    auto scores = inference::ScoresAt(box, boxes, labels);
    scores.goal = boxes[i].score;
    add(inference::DepthMask(obs.depth_m, {box, 0.5F, {}, 0}), {goal, std::nullopt, scores, false});
  }
  return {};
}

Result<void> Look(const fs::path& folder, Detectors& with, std::vector<Case>& cases) {
  const auto scene = sim::LoadScene(folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(*scene);
  SensorConfig sensor;
  sensor.width_px = sensor.height_px = kSide_px;
  sim::Simulator simulator(*scene, *navmesh, caster, sensor, {});
  for (const AgentPose& pose : LooksFrom(CoveringPoints(*navmesh, kSpacing_m, kMisses))) {
    if (!simulator.Reset(pose)) continue;
    const Observation obs = simulator.Observe();
    const auto boxes = with.second->DetectAll(obs, inference::kLeastScore);
    if (!boxes) return tl::unexpected(boxes.error());
    for (std::size_t goal = 0; goal < kGoals; ++goal)
      if (auto ok = AddCases(obs, goal, *boxes, *scene, with, cases); !ok) return ok;
  }
  std::fprintf(stderr, "%s: %zu boxes so far\n", folder.c_str(), cases.size());
  return {};
}

double Difference(const Case& c) {
  return inference::BoundedLogOdds(c.second.goal) - inference::BoundedLogOdds(c.second.rival);
}

/// Numbers of [opinion] by Newton's method on the likelihood of the log-odds.
inference::ModelCard::Opinion Fit(const std::vector<Case>& cases,
                                  const inference::ModelCard& card) {
  using Row = Eigen::Matrix<double, 1 + static_cast<int>(kSides), 1>;
  const auto row = [](const Case& c) {
    Row x = Row::Zero();
    x[0] = 1;
    x[1] = c.first ? inference::BoundedLogOdds(*c.first) : 0;
    x[2] = Difference(c);
    if (!c.first) x[3 + static_cast<int>(c.goal)] = 1;
    return x;
  };
  Row fit = Row::Zero();
  for (int i = 0; i < 50; ++i) {
    Row slope = -fit;  // chosen: a weak prior
    Eigen::Matrix<double, 1 + static_cast<int>(kSides), 1 + static_cast<int>(kSides)> curve;
    curve.setIdentity();
    for (const Case& c : cases) {
      const Row x = row(c);
      const double p = 1 / (1 + std::exp(-fit.dot(x)));
      slope += ((c.is_true ? 1 : 0) - p) * x;
      curve += p * (1 - p) * x * x.transpose();
    }
    fit += curve.ldlt().solve(slope);
  }
  inference::ModelCard::Opinion opinion;
  opinion.weight = fit[2] / fit[1];
  double sum = 0, n = 0, unseen = 0;
  for (const Case& c : cases)
    if (c.first && *c.first >= 0.6 && *c.first <= 0.8) sum += Difference(c), n += 1;
  opinion.neutral = -*opinion.weight * sum / std::max(1.0, n);
  opinion.unseen_of.assign(card.labels.size(), 0);
  for (std::size_t goal = 0; goal < kGoals; ++goal) {
    const double value = fit[3 + static_cast<int>(goal)] / fit[1];
    for (const int label : inference::LabelsOf(kCategories[goal], card.labels))
      opinion.unseen_of[static_cast<std::size_t>(label)] = value;
    unseen += value / static_cast<double>(kGoals);
  }
  opinion.unseen = unseen;
  return opinion;
}

void Print(const inference::ModelCard::Opinion& opinion, const inference::ModelCard& card) {
  std::printf("[opinion]\nweight = %.2f\nneutral = %.2f\nunseen = %.2f\n\n[opinion.unseen_of]\n",
              *opinion.weight, opinion.neutral, opinion.unseen);
  for (const auto goal : kCategories)
    for (const int label : inference::LabelsOf(goal, card.labels))
      std::printf("\"%s\" = %.2f\n", card.labels[static_cast<std::size_t>(label)].c_str(),
                  opinion.unseen_of[static_cast<std::size_t>(label)]);
}

/// True boxes among the best ones that hold `wrong` false boxes.
int TrueBefore(std::vector<std::pair<double, bool>> scored, int wrong) {
  std::stable_sort(scored.begin(), scored.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  int right = 0;
  for (const auto& [score, is_true] : scored) {
    if (!is_true && wrong-- == 0) break;
    right += is_true ? 1 : 0;
  }
  return right;
}

/// For each goal: true and false boxes that the first claims alone, and true boxes of the pair at
/// as many false ones and at half of them; the same of the first at half of them.
void Judge(const std::vector<Case>& cases, const inference::ModelCard& card,
           const inference::ModelCard::Opinion& opinion) {
  constexpr double kClaim = 0.7;
  std::printf("\n%-12s %6s %6s %22s %16s %15s\n", "goal", "false", "true", "pair, as many false",
              "first, half", "pair, half");
  for (std::size_t goal = 0; goal < kGoals; ++goal) {
    const auto labels = inference::LabelsOf(kCategories[goal], card.labels);
    if (labels.empty()) continue;
    std::vector<std::pair<double, bool>> alone, pair;
    int wrong = 0, right = 0;
    for (const Case& c : cases) {
      if (c.goal != goal) continue;
      if (c.first.value_or(0) >= kClaim) ++(c.is_true ? right : wrong);
      if (c.first) alone.emplace_back(*c.first, c.is_true);
      pair.emplace_back(inference::FusedConfidence(c.first, c.second.goal, c.second.rival,
                                                   labels.front(), opinion),
                        c.is_true);
    }
    std::printf("%-12s %6d %6d %22d %16d %15d\n", std::string(kCategories[goal]).c_str(), wrong,
                right, TrueBefore(pair, wrong), TrueBefore(alone, wrong / 2),
                TrueBefore(pair, wrong / 2));
  }
}

Result<void> Run(const fs::path& dir, const std::string& second,
                 const std::array<std::vector<fs::path>, 2>& houses) {
  auto set = inference::NetworkSet::Read({}, dir);
  if (!set) return tl::unexpected(set.error());
  auto suite = set->MakeSuite(SensorConfig{}.camera_height_m);
  if (!suite) return tl::unexpected(suite.error());
  auto card = inference::ReadModelCard(inference::CardPath(dir, second));
  if (!card) return tl::unexpected(card.error());
  inference::FindFile(*card);
  auto model = inference::Open(*card, {});
  if (!model) return tl::unexpected(model.error());
  Detectors with{std::move(*suite), std::move(*model), std::move(*card)};
  std::array<std::vector<Case>, 2> cases;
  for (std::size_t i = 0; i < 2; ++i)
    for (const fs::path& house : houses[i])
      if (auto ok = Look(house, with, cases[i]); !ok) return ok;
  const auto opinion = Fit(cases[0], with.card);
  Print(opinion, with.card);
  Judge(cases[1], with.card, opinion);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  std::array<std::vector<fs::path>, 2> houses;
  std::size_t half = 0;
  for (int i = 3; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--") {
      half = 1;
    } else {
      houses[half].emplace_back(argv[i]);
    }
  }
  if (houses[0].empty() || houses[1].empty())
    return std::fprintf(stderr, "NETWORKS_DIR SECOND HOUSE_FOLDER... -- HOUSE_FOLDER...\n"), 2;
  const auto ok = Run(argv[1], argv[2], houses);
  if (!ok) return std::fprintf(stderr, "%s\n", ok.error().Message().c_str()), 1;
  return 0;
}
