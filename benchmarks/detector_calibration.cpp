// SPDX-License-Identifier: MIT
// How often a detector's score is right, and what several views of one thing say together
// (crossnav/policy/view_evidence.h): houses are looked at from covering points, each sighting is
// held against the objects that are there. Usage:
//   detector_calibration NETWORKS_DIR HOUSE_FOLDER...
// Prints a reliability diagram of the score, the fitted line of log-odds (verify.score_offset,
// verify.score_slope) with the diagram of its probabilities, then of things seen from several views
// for each discount. The first half of the houses fits, the second half is judged.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "covering_points.h"
#include "crossnav/core/categories.h"
#include "crossnav/inference/suite.h"
#include "crossnav/policy/claim.h"
#include "crossnav/policy/live_poi.h"
#include "crossnav/sim/render/ray_caster.h"
#include "crossnav/sim/scene/scene.h"
#include "crossnav/sim/sensing/simulator.h"

namespace {

using namespace crossnav;  // NOLINT: a program, not a header
namespace fs = std::filesystem;

constexpr double kSpacing_m = 1.6;  // between the places from which a house is seen
constexpr int kYaws = 6, kSide_px = 320;
constexpr double kMargin_m = 0.2;  // of an object's box: voxels, and the detector's mask
constexpr double kInside = 0.5;    // share of a sighting's voxels that makes it the object's
constexpr double kLeastScore = 0.4;

struct Scored {
  double score = 0;
  bool is_true = false;
};

/// Claimed object, with the score of each view.
struct Thing {
  policy::LivePoi poi;
  policy::ClaimTracker book;
  std::vector<double> scores;
  std::vector<Vector3d> p_cameras_world;
  bool is_true = false;
};

struct House {
  std::vector<Scored> sightings;
  std::vector<Thing> things;
};

bool IsThere(const policy::Sighting& sighting, std::string_view goal, const sim::Scene& scene,
             double voxel_m) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const auto& instance) {
    if (instance.category != goal) return false;
    const auto inside =
        std::count_if(sighting.voxels.begin(), sighting.voxels.end(), [&](const auto& key) {
          const Vector3d p = geometry::CenterOf(key, voxel_m);
          return (p.array() >= instance.box.min.array() - kMargin_m).all() &&
                 (p.array() <= instance.box.max.array() + kMargin_m).all();
        });
    return static_cast<double>(inside) >= kInside * static_cast<double>(sighting.voxels.size());
  });
}

void NoteThing(const policy::Sighting& sighting, const Vector3d& p_camera, bool is_true,
               std::vector<Thing>& things) {
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
  it->scores.push_back(sighting.confidence);
  it->p_cameras_world.push_back(p_camera);
}

Result<House> Look(const fs::path& folder, perception::PerceptionSuite& suite) {
  const auto scene = sim::LoadScene(folder);
  if (!scene) return tl::unexpected(scene.error());
  const auto navmesh = sim::NavMesh::Build(*scene, {});
  if (!navmesh) return tl::unexpected(navmesh.error());
  const sim::RayCaster caster(*scene);
  SensorConfig sensor;
  sensor.width_px = sensor.height_px = kSide_px;
  sim::Simulator simulator(*scene, *navmesh, caster, sensor, {});
  const geometry::MapConfig map;
  House house;
  std::array<std::vector<Thing>, kCategories.size()> things;
  for (const Vector3d& p : CoveringPoints(*navmesh, kSpacing_m, 150))
    for (int yaw = 0; yaw < kYaws; ++yaw) {
      if (!simulator.Reset({p, yaw * 2 * M_PI / kYaws, yaw % 2 == 0 ? 0 : DegToRad(-30)})) continue;
      const Observation obs = simulator.Observe();
      for (std::size_t g = 0; g < kCategories.size(); ++g) {
        auto found = suite.detector->Detect(obs, kCategories[g]);
        if (!found) return tl::unexpected(found.error());
        for (auto& detection : *found)
          if (auto ok = suite.segmenter->Segment(obs, detection); !ok)
            return tl::unexpected(ok.error());
        for (const auto& sighting : policy::LiftDetections(*found, obs, map, {}, kLeastScore)) {
          const bool is_true = IsThere(sighting, kCategories[g], *scene, map.voxel_m);
          house.sightings.push_back({sighting.confidence, is_true});
          NoteThing(sighting, obs.T_world_camera.translation(), is_true, things[g]);
        }
      }
    }
  for (auto& some : things)
    house.things.insert(house.things.end(), std::make_move_iterator(some.begin()),
                        std::make_move_iterator(some.end()));
  return house;
}

/// Offset and slope of the log-odds, by Newton's method on the likelihood.
policy::EvidenceConfig Fit(const std::vector<Scored>& all) {
  policy::EvidenceConfig fit;
  const policy::EvidenceConfig plain;
  for (int i = 0; i < 50; ++i) {
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Matrix2d curve = 1e-6 * Eigen::Matrix2d::Identity();
    for (const Scored& s : all) {
      const Eigen::Vector2d x(1, policy::LogOddsOf(s.score, plain));
      const double p = 1 / (1 + std::exp(-(fit.offset + fit.slope * x[1])));
      slope += ((s.is_true ? 1 : 0) - p) * x;
      curve += p * (1 - p) * x * x.transpose();
    }
    const Eigen::Vector2d step = curve.inverse() * slope;
    fit.offset += step[0];
    fit.slope += step[1];
  }
  return fit;
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

std::vector<Scored> Fused(const std::vector<Thing>& things, const policy::EvidenceConfig& fit) {
  std::vector<Scored> all;
  policy::VerifyConfig config;
  config.views = fit;
  for (Thing thing : things) {
    for (std::size_t i = 0; i < thing.scores.size(); ++i) {
      policy::Sighting sighting;
      sighting.voxels = thing.poi.voxels;
      sighting.p_center_world = thing.poi.p_center_world;
      sighting.confidence = thing.scores[i];
      policy::NoteScores({thing.poi}, {sighting}, thing.p_cameras_world[i], {}, config,
                         &thing.book);
    }
    const auto* views = thing.book.ViewsOf(thing.poi.id);
    if (views == nullptr || views->scores.size() < 2) continue;
    all.push_back({policy::ProbabilityOf(views->scores, fit), thing.is_true});
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return std::fprintf(stderr, "NETWORKS_DIR and two HOUSE_FOLDERs or more\n"), 2;
  auto set = inference::NetworkSet::Read({}, argv[1]);
  auto suite = set ? set->MakeSuite(SensorConfig{}.camera_height_m)
                   : Result<perception::PerceptionSuite>(tl::unexpected(set.error()));
  if (!suite) return std::fprintf(stderr, "%s\n", suite.error().Message().c_str()), 1;
  std::array<House, 2> halves;
  for (int i = 2; i < argc; ++i) {
    auto house = Look(argv[i], *suite);
    if (!house) return std::fprintf(stderr, "%s\n", house.error().Message().c_str()), 1;
    House& half = halves[i - 2 < (argc - 2) / 2 ? 0 : 1];
    std::fprintf(stderr, "%s: %zu sightings\n", argv[i], house->sightings.size());
    half.sightings.insert(half.sightings.end(), house->sightings.begin(), house->sightings.end());
    half.things.insert(half.things.end(), house->things.begin(), house->things.end());
  }
  PrintDiagram("scores as they are", halves[1].sightings);
  policy::EvidenceConfig fit = Fit(halves[0].sightings);
  std::printf("verify.score_offset=%.2f verify.score_slope=%.2f\n", fit.offset, fit.slope);
  std::vector<Scored> calibrated = halves[1].sightings;
  for (Scored& s : calibrated) s.score = 1 / (1 + std::exp(-policy::LogOddsOf(s.score, fit)));
  PrintDiagram("scores on the fitted line", calibrated);
  for (const double discount : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    fit.discount = discount;
    std::printf("verify.view_discount=%.2f, fitted half: ", discount);
    PrintDiagram("things seen from several views", Fused(halves[0].things, fit));
    PrintDiagram("  the other half", Fused(halves[1].things, fit));
  }
  return 0;
}
