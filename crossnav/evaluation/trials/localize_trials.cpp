// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/localize_trials.h"

#include <cmath>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/running/survey.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/world/house/house_generator.h"
#include "crossnav/world/shell/architecture.h"

namespace crossnav::evaluation {
namespace {

constexpr int kPointDraws = 10000;  // chosen: until a point lies on the floor that was asked for

Result<AgentPose> DrawPose(const SceneContext& context, Rng& rng, int floor) {
  for (int draw = 0; draw < kPointDraws; ++draw) {
    const auto p = context.navmesh().RandomPoint(rng);
    if (!p) break;
    const double yaw_rad = WrapAngle(rng.Uniform(0, DegToRad(360)));
    if (context.navmesh().FloorOf(*p) == floor) return AgentPose{*p, yaw_rad, 0};
  }
  return Fail(ErrorCode::kNotFound, "no place to stand on floor " + std::to_string(floor),
              context.scene().id);
}

void Judge(const Observation& obs, const AgentPose& truth, double camera_height_m,
           LostTrial& trial) {
  Observation placed = obs;
  placed.depth_m = {}, placed.rgb = {};
  placed.T_world_camera = trial.answer.T_map_odom * obs.T_world_camera;
  const AgentPose said = FootPoseOf(placed, camera_height_m);
  trial.off_m = (said.p_world - truth.p_world).norm();
  trial.off_deg = std::abs(RadToDeg(WrapAngle(said.yaw_rad - truth.yaw_rad)));
}

}  // namespace

Result<LostTrial> TryLost(const SceneContext& context, const localization::PlacedMap& map,
                          const RunConfig& config, std::uint64_t seed, int number) {
  const std::uint64_t trial_seed = MixSeed(seed, static_cast<std::uint64_t>(number));
  Rng rng(trial_seed);
  LostTrial trial;
  trial.house = context.scene().id;
  trial.floor = number % static_cast<int>(context.navmesh().Floors().size());
  const auto start = DrawPose(context, rng, trial.floor);
  if (!start) return tl::unexpected(start.error());
  sim::Simulator simulator(context.scene(), context.navmesh(), context.caster(),
                           config.agent.sensor, config.agent.action);
  simulator.ShowColour(false);
  simulator.UseNoise(config.noise, trial_seed);
  if (auto ok = simulator.Reset(*start); !ok) return tl::unexpected(ok.error());
  trial.start = simulator.agent();
  const Pose T_odom_world = localization::FootFrameOf(trial.start).inverse();
  const double camera_height_m = config.agent.sensor.camera_height_m;
  localization::Localizer localizer(map, {camera_height_m, config.agent.action, config.agent.map});
  for (;;) {
    Observation obs = simulator.Observe();
    obs.T_world_camera = T_odom_world * obs.T_world_camera;
    const double before_ms = CpuMs();
    trial.answer = localizer.Step(obs);
    trial.cpu_s += (CpuMs() - before_ms) * 1e-3;
    trial.actions = localizer.actions();
    if (trial.answer.status != localization::Status::kLocalising) {
      Judge(obs, simulator.agent(), camera_height_m, trial);
      return trial;
    }
    simulator.Step(trial.answer.action);
  }
}

Result<localization::PlacedMap> SurveyedMap(const SceneContext& context, const RunConfig& config) {
  const auto survey = SurveyScene(context, config, Known::kMap);
  if (!survey) return tl::unexpected(survey.error());
  return localization::PlaceMap(survey->map);
}

Result<std::unique_ptr<SceneContext>> TwinHouse(std::uint64_t seed, world::TwinFurniture furniture,
                                                const RunConfig& config) {
  world::HouseParams params;
  params.seed = seed;
  params.floors = 2;
  params.has_textures = false;
  std::string why = "no plan could be drawn";
  for (int attempt = 0; attempt < world::AttemptsFor(params); ++attempt) {
    const auto plan = world::DrawFurnishedPlan(params, attempt);
    if (!plan) continue;
    Rng rng(MixSeed(seed, static_cast<std::uint64_t>(attempt)));
    const auto twin = world::TwinFloors(*plan, furniture, {}, rng);
    if (!twin) {
      why = twin.error().what;
      continue;
    }
    auto context = SceneContext::Of(world::BuildHouse(*twin), config);
    if (!context) return context;
    const sim::NavMesh& navmesh = (*context)->navmesh();
    if (navmesh.Floors().size() == 2 && !navmesh.Connections().empty()) return context;
    why = "its floors are not connected";
  }
  return Fail(ErrorCode::kNotFound, "no twin floors: " + why, world::SceneIdOf(params));
}

}  // namespace crossnav::evaluation
