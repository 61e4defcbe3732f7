// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/survey.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "crossnav/memory/row_kernels.h"
#include "crossnav/policy/flight_survey.h"
#include "crossnav/policy/stair_evidence.h"
#include "crossnav/sim/sensing/ground_truth.h"
#include "crossnav/sim/sensing/simulator.h"

namespace crossnav::evaluation {
namespace {

using geometry::VoxelKey;

// chosen: four sides reveal most furniture
constexpr double kPlacesApart_m = 1.0;
constexpr std::array<double, 2> kPitches_deg = {0,
                                                -30};  // chosen: ahead, and the ground at the feet
constexpr int kSurveyYaws = 4;                         // chosen: a field of view of 90 degrees
constexpr int kSurveyStep_px = 2;     // chosen: an object's voxel shows in many pixels
constexpr int kBackgroundShare = 8;   // chosen: one in eight background voxels is kept
constexpr float kCertainWeight = 10;  // chosen: ten frames at the best distance

/// Points of the walkable surface, each `kPlacesApart_m` from the points before it, by x, y, z.
std::vector<Vector3d> PlacesOf(const SceneContext& context) {
  std::vector<Vector3d> places;
  for (const Vector3d& p : context.WalkablePoints()) {
    const bool is_near = std::any_of(places.begin(), places.end(), [&](const Vector3d& other) {
      return (other - p).norm() < kPlacesApart_m - 1e-6;
    });
    if (!is_near) places.push_back(p);
  }
  return places;
}

/// Instances that the views show at a voxel.
struct ShownVoxel {
  std::map<int, int> pixels;  // by instance
  double nearest_m = 1e9;
  Vector3f p_eye_world = Vector3f::Zero();
};

class Surveyor {
 public:
  Surveyor(const SceneContext& context, const RunConfig& config, perception::PerceptionSuite& suite,
           sim::Simulator& simulator, const OnView& on_view)
      : on_view_(on_view),
        context_(context),
        config_(config),
        suite_(suite),
        simulator_(simulator),
        survey_{geometry::VoxelMap(config.agent.map),
                memory::SemanticMemory(config.agent.fusion, config.agent.map.voxel_m),
                {},
                {}} {
    for (const sim::Floor& floor : context.navmesh().Floors()) levels_m_.push_back(floor.height_m);
  }

  Result<void> LookAround(const Vector3d& p_world, bool with_objects);
  Result<void> NameObjects();
  SceneSurvey Finish() {
    survey_.seen_stairs = stairs_.Export();
    return std::move(survey_);
  }

 private:
  Result<void> Look(bool with_objects);
  void NoteObjects(const Observation& obs);

  const OnView& on_view_;
  const SceneContext& context_;
  const RunConfig& config_;
  perception::PerceptionSuite& suite_;
  sim::Simulator& simulator_;
  SceneSurvey survey_;
  policy::StairEvidence stairs_;
  policy::FlightSurvey flight_survey_;
  std::vector<double> levels_m_;
  std::map<VoxelKey, ShownVoxel> shown_;
};

Result<void> Surveyor::LookAround(const Vector3d& p_world, bool with_objects) {
  ++survey_.places;
  for (int yaw = 0; yaw < kSurveyYaws; ++yaw) {
    for (const double pitch_deg : kPitches_deg) {
      const AgentPose pose{p_world, DegToRad(360.0 * yaw / kSurveyYaws), DegToRad(pitch_deg)};
      if (auto ok = simulator_.Reset(pose); !ok) return ok;
      if (auto ok = Look(with_objects); !ok) return ok;
    }
  }
  return {};
}

/// Integrates one view into the map, as Agent::Step does.
Result<void> Surveyor::Look(bool with_objects) {
  const Observation obs = simulator_.Observe();
  const auto& ends = survey_.map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
  survey_.map.ObserveBody(simulator_.agent().p_world, config_.agent.sensor.camera_height_m);
  survey_.map.UpdateStates();
  const auto stairs = suite_.stairs->SegmentStairs(obs);
  if (!stairs) return tl::unexpected(stairs.error());
  stairs_.Update(*stairs, ends.runs(), survey_.map, config_.agent.policy.stair, survey_.views++);
  flight_survey_.Update(stairs_, levels_m_, simulator_.agent().p_world, config_.agent.map.voxel_m,
                        &survey_.flights);
  if (with_objects) NoteObjects(obs);
  if (on_view_) on_view_(obs, simulator_);
  return {};
}

void Surveyor::NoteObjects(const Observation& obs) {
  const geometry::MapConfig& map = config_.agent.map;
  const InstanceImage& instance = simulator_.last_frame().instance;
  const Vector3d p_eye = obs.T_world_camera.translation();
  for (int v = 0; v < instance.height; v += kSurveyStep_px) {
    for (int u = 0; u < instance.width; u += kSurveyStep_px) {
      const float depth_m = obs.depth_m.At(u, v);
      if (!(depth_m >= map.depth_min_m && depth_m <= map.depth_max_m)) continue;
      const sim::SceneInstance* seen = context_.scene().FindInstance(instance.At(u, v));
      if (seen == nullptr) continue;
      const Vector3d p_world = obs.T_world_camera * BackProjectPixel(obs.camera, u, v, depth_m);
      const VoxelKey key = geometry::KeyOf(p_world, map.voxel_m);
      const int mixed = key.x + 3 * key.y + 5 * key.z;
      if (seen->category.empty() && mixed % kBackgroundShare != 0) continue;
      ShownVoxel& shown = shown_[key];
      ++shown.pixels[seen->id];
      if (const double away_m = (p_world - p_eye).norm(); away_m < shown.nearest_m) {
        shown.nearest_m = away_m;
        shown.p_eye_world = p_eye.cast<float>();
      }
    }
  }
}

/// Writes the text vector of the instance's name, by the agent's encoder, as the feature of each
/// voxel that mostly showed the instance.
Result<void> Surveyor::NameObjects() {
  std::map<std::string, std::vector<std::uint16_t>> half;  // by name
  for (const auto& [key, shown] : shown_) {
    if (!geometry::IsSurface(survey_.map.StateAt(key))) continue;
    const auto most =
        std::max_element(shown.pixels.begin(), shown.pixels.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const sim::SceneInstance& instance = *context_.scene().FindInstance(most->first);
    const std::string& name = instance.category.empty() ? instance.name : instance.category;
    auto& bits = half[name];
    if (bits.empty()) {
      const auto text = suite_.encoder->EncodeText(name);
      if (!text) return tl::unexpected(text.error());
      bits.resize(text->size());
      memory::ToHalf(*text, bits.data());
    }
    memory::MemoryRow row;
    row.key = key;
    row.weight = kCertainWeight;
    row.best_confidence = 1;
    row.p_best_view_world = shown.p_eye_world;
    row.half = bits;
    survey_.memory.AppendRow(row);
  }
  return {};
}

}  // namespace

Known KnownOf(const std::string& variant) {
  if (variant == "known-map") return Known::kMap;
  return variant == "known-objects" ? Known::kObjects : Known::kNothing;
}

std::vector<AgentPose> SurveyPoses(const SceneContext& context) {
  std::vector<AgentPose> poses;
  for (const Vector3d& p_world : PlacesOf(context))
    for (int yaw = 0; yaw < kSurveyYaws; ++yaw)
      for (const double pitch_deg : kPitches_deg)
        poses.push_back({p_world, DegToRad(360.0 * yaw / kSurveyYaws), DegToRad(pitch_deg)});
  return poses;
}

Result<SceneSurvey> SurveyScene(const SceneContext& context, const RunConfig& config, Known known,
                                const OnView& on_view) {
  const bool with_objects = known == Known::kObjects;
  if (with_objects && config.eval.perception != "oracle") {
    return Fail(ErrorCode::kUnsupported,
                "known-objects needs ground truth's features; leave eval.perception = oracle",
                "--variant");
  }
  sim::Simulator simulator(context.scene(), context.navmesh(), context.caster(),
                           config.agent.sensor, config.agent.action);
  simulator.ShowColour(static_cast<bool>(on_view));
  auto suite = sim::GroundTruthPerception(simulator, config.ground_truth);
  if (!suite) return tl::unexpected(suite.error());
  Surveyor surveyor(context, config, *suite, simulator, on_view);
  for (const Vector3d& p : PlacesOf(context)) {
    if (auto ok = surveyor.LookAround(p, with_objects); !ok) return tl::unexpected(ok.error());
  }
  if (with_objects) {
    if (auto ok = surveyor.NameObjects(); !ok) return tl::unexpected(ok.error());
  }
  return surveyor.Finish();
}

}  // namespace crossnav::evaluation
