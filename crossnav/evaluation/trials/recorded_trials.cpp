// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/recorded_trials.h"

#include <algorithm>
#include <cmath>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/localization/belief.h"
#include "crossnav/scenegraph/storeys.h"

namespace crossnav::evaluation {
namespace {

constexpr int kOfEach = 3, kMapped = 1;  // the second of each three frames
constexpr double kScanVoxel_m = 0.05;    // as the localizer
constexpr double kMove_m = 10;           // chosen: of the odometry's origin, beyond any room

/// The map's frame as a robot's odometry knows it.
Pose DrawOdometry(Rng& rng) {
  Pose T = Pose::Identity();
  T.linear() =
      Eigen::AngleAxisd(rng.Uniform(0, DegToRad(360)), Vector3d::UnitZ()).toRotationMatrix();
  for (const int axis : {2, 1, 0}) T.translation()[axis] = rng.Uniform(-kMove_m, kMove_m);
  return T;
}

/// A robot that wakes up at frame `first` of `views`.
LostTrial WakeUp(const localization::PlacedMap& map, const std::vector<const Observation*>& views,
                 std::size_t first, int most_views, double camera_height_m, Rng& rng) {
  const localization::LocalizeConfig config;
  const Pose T_odom_map = DrawOdometry(rng);
  localization::LocalScan scan(kScanVoxel_m, config.reach_m + 1);
  localization::Belief belief(map, config);
  LostTrial trial;
  trial.start = FootPoseOf(*views[first], camera_height_m);
  const std::size_t end = std::min(views.size(), first + static_cast<std::size_t>(most_views));
  for (std::size_t i = first; i < end; ++i) {
    Observation obs = *views[i];
    obs.T_world_camera = T_odom_map * obs.T_world_camera;
    ++trial.actions;
    const double before_ms = CpuMs();
    scan.Add(obs);
    belief.Search(scan, FootPoseOf(obs, camera_height_m).p_world);
    trial.cpu_s += (CpuMs() - before_ms) * 1e-3;
    trial.answer = belief.opinion();
    if (!trial.IsKnown()) continue;
    const AgentPose truth = FootPoseOf(*views[i], camera_height_m);
    obs.T_world_camera = trial.answer.T_map_odom * obs.T_world_camera;
    const AgentPose said = FootPoseOf(obs, camera_height_m);
    trial.off_m = (said.p_world - truth.p_world).norm();
    trial.off_deg = std::abs(RadToDeg(WrapAngle(said.yaw_rad - truth.yaw_rad)));
    return trial;
  }
  trial.answer.status = localization::Status::kUnknown;
  return trial;
}

}  // namespace

Result<RecordedTrials> TryRecorded(const std::vector<Observation>& frames, const RunConfig& config,
                                   int most_views, std::uint64_t seed) {
  RecordedTrials result;
  geometry::VoxelMap map(config.agent.map);
  std::vector<const Observation*> views;
  std::vector<double> eyes_m;
  for (const Observation& obs : frames) {
    if (result.frames++ % kOfEach != kMapped) {
      views.push_back(&obs);
      continue;
    }
    map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
    map.UpdateStates();
    eyes_m.push_back(obs.T_world_camera.translation().z());
    ++result.mapped;
  }
  const auto storeys = scenegraph::FindStoreys(map);
  if (storeys.empty())
    return Fail(ErrorCode::kInvalid, "the frames show no ground to stand on", "recording");
  result.camera_height_m = PercentileOf(eyes_m, 0.5) - storeys.front().height_m;
  // Nobody walked into the map's frames: the places where the bearer stood are free.
  for (std::size_t i = kMapped; i < frames.size(); i += kOfEach)
    map.ObserveBody(FootPoseOf(frames[i], result.camera_height_m).p_world, result.camera_height_m);
  map.UpdateStates();
  const auto placed = localization::PlaceMap(map);
  if (!placed) return tl::unexpected(placed.error());
  Rng rng(seed);
  for (std::size_t i = 0; i < views.size(); ++i)
    result.trials.push_back(WakeUp(*placed, views, i, most_views, result.camera_height_m, rng));
  return result;
}

}  // namespace crossnav::evaluation
