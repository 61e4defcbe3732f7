// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/trials/stair_trials.h"

#include <cmath>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/running/runner.h"
#include "crossnav/sim/sensing/ground_truth.h"
#include "crossnav/sim/sensing/simulator.h"
#include "crossnav/world/shell/architecture.h"

namespace crossnav::evaluation {
namespace {

constexpr double kSameFloor_m = 0.25;  // chosen: below two risers

/// Region of possible starts, and the point that a start must see.
struct View {
  double floor_m = 0;
  Vector3d p_seen_world = Vector3d::Zero();
};

/// Whether an agent's camera at `start` sees the point: in the picture, not occluded.
bool Sees(const SceneContext& context, const AgentPose& start, const Vector3d& p_world,
          const SensorConfig& sensor) {
  constexpr double kBefore_m = 0.15;  // chosen: the object itself may surround the point
  const Pose T_world_camera = CameraPose(start, sensor.camera_height_m);
  const CameraIntrinsics camera = sensor.Intrinsics();
  const Vector3d p_camera = T_world_camera.inverse() * p_world;
  if (p_camera.z() <= 0) return false;
  const double u = camera.fx * p_camera.x() / p_camera.z() + camera.cx;
  const double v = camera.fy * p_camera.y() / p_camera.z() + camera.cy;
  if (u < 0 || v < 0 || u > camera.width_px - 1 || v > camera.height_px - 1) return false;
  const Vector3d ray = p_world - T_world_camera.translation();
  return !context.caster().Cast(T_world_camera.translation(), ray.normalized(),
                                ray.norm() - kBefore_m);
}

Result<AgentPose> DrawStart(const SceneContext& context, const View& view, std::uint64_t seed,
                            const RunConfig& config) {
  constexpr int kTries = 5000;  // chosen: a small world has a few m2 to hit
  constexpr double kNearest_m = 1.0, kFarthest_m = 6.0;  // chosen: within a room's length
  constexpr double kAside_deg = 35;                      // chosen: well inside the picture
  Rng rng(seed, 7);
  for (int i = 0; i < kTries; ++i) {
    const auto p = context.navmesh().RandomPoint(rng);
    if (!p || std::abs(p->z() - view.floor_m) > 0.1) continue;
    const Vector3d to_seen = view.p_seen_world - *p;
    const double distance_m = to_seen.head<2>().norm();
    if (distance_m < kNearest_m || distance_m > kFarthest_m) continue;
    AgentPose start{*p, std::atan2(to_seen.y(), to_seen.x()), 0};
    start.yaw_rad = WrapAngle(start.yaw_rad + DegToRad(rng.Uniform(-kAside_deg, kAside_deg)));
    if (Sees(context, start, view.p_seen_world, config.agent.sensor)) return start;
  }
  return Fail(ErrorCode::kNotFound, "no place on the floor sees the entrance",
              context.scene().id + " seed " + std::to_string(seed));
}

/// Notes whether the agent reached a height.
class HeightWatch : public RunObserver {
 public:
  explicit HeightWatch(double height_m) : height_m_(height_m) {}
  Result<void> OnStep(const StepView& step) override {
    Note(step.agent.p_world);
    return {};
  }
  Result<void> OnStageEnd(const StageRecord& stage) override {
    Note(stage.end_world);
    return {};
  }
  bool reached() const { return reached_; }

 private:
  void Note(const Vector3d& p_world) {
    reached_ = reached_ || std::abs(p_world.z() - height_m_) < kSameFloor_m;
  }
  double height_m_;
  bool reached_ = false;
};

std::optional<FalseStart> StartedStair(const trace::StepTrace& step) {
  const bool is_session = step.activity.empty() && step.mode == "stair_explore";
  if (step.activity != "climb" && !is_session) return std::nullopt;
  FalseStart started{step.step, step.agent.p_world, step.agent.p_world, {}};
  for (const trace::CandidateTrace& candidate : step.candidates) {
    if (!candidate.is_target) continue;
    started.p_target_world = candidate.p_nav_world;
    started.target_kind = candidate.kind;
  }
  return started;
}

}  // namespace

Result<StairSite> BuildStairSite(StairWorld world, const RunConfig& config) {
  StairSite site{std::move(world), nullptr};
  auto context = SceneContext::Of(world::BuildHouse(site.world.plan), config);
  if (!context) return tl::unexpected(context.error());
  site.context = std::move(*context);
  return site;
}

Result<StairAttempt> TryStair(const StairSite& site, bool goes_up, std::uint64_t seed,
                              const RunConfig& config) {
  const StairWorld& world = site.world;
  const Vector3d above_ground(0, 0, 0.1);
  const View view{goes_up ? world.lower_m : world.upper_m,
                  (goes_up ? world.p_foot_world : world.p_top_world) + above_ground};
  const auto start = DrawStart(*site.context, view, MixSeed(seed, goes_up ? 1 : 2), config);
  if (!start) return tl::unexpected(start.error());
  StairAttempt attempt;
  attempt.episode.scene_id = world.plan.id;
  attempt.episode.start = *start;
  attempt.episode.goals = {goes_up ? kGoalAbove : kGoalBelow};
  attempt.episode.episode_id = ContentId(attempt.episode);
  attempt.episode.where = world.plan.id;
  Certify(*site.context, attempt.episode);
  HeightWatch watch(goes_up ? world.upper_m : world.lower_m);
  RunObserver* observers[] = {&watch};
  auto record = RunEpisode(*site.context, attempt.episode, config, observers);
  if (!record) return tl::unexpected(record.error());
  attempt.record = std::move(*record);
  attempt.reached = watch.reached();
  return attempt;
}

Result<FalseAttempt> TryFalseEntrance(FalseEntrance kind, std::uint64_t seed,
                                      const RunConfig& config) {
  const FalseWorld world = MakeFalseWorld(kind, seed);
  const auto context = SceneContext::Of(world::BuildHouse(world.plan), config);
  // Furniture may leave no walkable ground.
  if (!context) return Fail(ErrorCode::kNotFound, context.error().what, context.error().where);
  const auto start = DrawStart(**context, {world.start_m, world.p_seen_world}, seed, config);
  if (!start) return tl::unexpected(start.error());
  sim::Simulator simulator((*context)->scene(), (*context)->navmesh(), (*context)->caster(),
                           config.agent.sensor, config.agent.action);
  simulator.ShowColour(false);
  auto perception = sim::GroundTruthPerception(simulator, config.ground_truth);
  if (!perception) return tl::unexpected(perception.error());
  agent::Agent agent(config.agent, std::move(*perception));
  if (auto ok = simulator.Reset(*start); !ok) return tl::unexpected(ok.error());
  // The world has no toilet.
  if (auto ok = agent.SetGoal("toilet"); !ok) return tl::unexpected(ok.error());
  FalseAttempt attempt;
  while (attempt.actions < config.eval.action_budget && !attempt.started) {
    const auto step = agent.Step(simulator.Observe());
    if (!step) return tl::unexpected(step.error());
    attempt.started = StartedStair(step->trace);
    attempt.all_explored = step->all_explored;
    if (step->all_explored || step->action == Action::kStop) break;
    simulator.Step(step->action);
    ++attempt.actions;
  }
  return attempt;
}

}  // namespace crossnav::evaluation
