// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/runner.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <optional>

#include "crossnav/core/rng.h"
#include "crossnav/evaluation/episodes/picture_view.h"
#include "crossnav/evaluation/records/goal_kind.h"
#include "crossnav/evaluation/running/timing.h"
#include "crossnav/evaluation/running/walk_log.h"
#include "crossnav/evaluation/scoring/cause.h"
#include "crossnav/evaluation/scoring/outcome.h"
#include "crossnav/localization/awakening.h"
#include "crossnav/sim/sensing/ground_truth.h"
#include "crossnav/sim/sensing/simulator.h"

namespace crossnav::evaluation {
namespace {

/// The floor under the agent; on a flight, the last floor.
class FloorWatch {
 public:
  FloorWatch(const sim::NavMesh& navmesh, const Vector3d& p_world)
      : navmesh_(navmesh), floor_(navmesh.FloorOf(p_world)) {}

  void Move(const Vector3d& p_world) {
    constexpr double kOnFloor_m = 0.3;  // chosen: one step of a stair at most
    const int floor = navmesh_.FloorOf(p_world);
    if (floor == floor_) return;
    for (const sim::Floor& candidate : navmesh_.Floors()) {
      if (candidate.id != floor) continue;
      if (candidate.GapTo(p_world.z()) > kOnFloor_m) return;
    }
    floor_ = floor;
    ++transitions_;
  }
  int floor() const { return floor_; }
  int transitions() const { return transitions_; }
  void StartStage() { transitions_ = 0; }

 private:
  const sim::NavMesh& navmesh_;
  int floor_;
  int transitions_ = 0;
};

/// Whether the goal is a description or a picture.
bool MeansOneInstance(const std::string& goal) {
  return KindOf(goal) != GoalKind::kCategory;
}

/// The episode's pictures by name, for ground-truth perception.
sim::KnownPictures KnownPicturesOf(const Episode& episode) {
  sim::KnownPictures known;
  for (const auto& [name, picture] : episode.pictures) known[name] = ViewOf(*picture);
  return known;
}

/// State of one episode.
class EpisodeRun {
 public:
  EpisodeRun(const SceneContext& context, const Episode& episode, const RunConfig& config,
             sim::Simulator& simulator, agent::Agent& agent)
      : context_(context),
        episode_(episode),
        config_(config),
        simulator_(simulator),
        agent_(agent) {}

  Result<EpisodeRecord> Run(std::span<RunObserver* const> observers);

 private:
  struct StageState {
    explicit StageState(const std::vector<sim::Floor>& floors) : cause(floors) {}
    StageRecord record;
    CauseWatch cause;
    StairWatch stairs;
    WalkLog walk;
    bool was_in_view = false;
    int actions_before = 0;
  };

  Result<void> WakeUp();
  Result<void> Localise(store::LoadedMemory memory);
  Observation Observe();
  Result<StageRecord> RunStage(const std::string& goal);
  Result<bool> StepOnce(StageState& stage, StageEnd& end);  // true = the stage is over
  void AddCost(const StepCost& cost);
  void Move(Action action, StageState& stage);
  void NotePassing(StageState& stage) const;
  void FinishStage(const StageEnd& end, StageState& stage) const;
  bool IsClaimNear(const std::string& goal, const Vector3d& p_claimed_world) const;
  bool IsClaimOf(const std::string& goal, const Vector3d& p_claimed_world) const;
  bool HasBudget(int actions_before) const {
    const bool is_per_goal = config_.eval.budget_scope == "goal";
    return actions_ - (is_per_goal ? actions_before : 0) < config_.eval.action_budget;
  }

  const SceneContext& context_;
  const Episode& episode_;
  const RunConfig& config_;
  std::span<RunObserver* const> observers_;
  sim::Simulator& simulator_;
  agent::Agent& agent_;
  std::optional<FloorWatch> floors_;
  std::deque<double> recent_m_;  // displacement of the last eval.stuck_steps steps
  int actions_ = 0;
  TimingLog timing_;
  // The frame that the agent's poses are in. Another than the world's after waking up lost: the
  // map's, as far as the localisation is right, or that of the start.
  Pose T_agent_world_ = Pose::Identity();
  Pose T_world_claims_ = Pose::Identity();  // of the agent's claims; a map's frame is the world's
};

Result<EpisodeRecord> EpisodeRun::Run(std::span<RunObserver* const> observers) {
  observers_ = observers;
  // Ground-truth perception reads the instance image, never the colours; networks the reverse.
  // Descriptions may name colours, pictures show them.
  simulator_.ShowColour(config_.eval.perception != "oracle" ||
                        std::any_of(episode_.goals.begin(), episode_.goals.end(),
                                    [](const auto& goal) { return MeansOneInstance(goal); }) ||
                        std::any_of(observers.begin(), observers.end(),
                                    [](const RunObserver* o) { return o->NeedsColour(); }));
  const double start_ms = WallMs();
  if (auto ok = CheckPlayable(context_, episode_); !ok) return tl::unexpected(ok.error());
  if (auto ok = simulator_.Reset(episode_.start); !ok) {
    return Fail(ok.error().code, ok.error().what, episode_.where + ": start_position");
  }
  floors_.emplace(context_.navmesh(), simulator_.agent().p_world);
  EpisodeRecord record;
  record.episode_id = episode_.episode_id;
  record.scene_id = episode_.scene_id;
  record.track = episode_.track;
  record.cross_floor_required = episode_.cross_floor_required;
  record.first_transition_stage = episode_.first_transition_stage;
  record.goals = episode_.goals;
  for (RunObserver* observer : observers_) {
    if (auto ok = observer->OnStart(agent_); !ok) return tl::unexpected(ok.error());
  }
  if (auto ok = WakeUp(); !ok) return tl::unexpected(ok.error());
  for (const std::string& goal : episode_.goals) {
    if (!HasBudget(actions_)) break;  // a stage without an action leaves no row
    auto stage = RunStage(goal);
    if (!stage) return tl::unexpected(stage.error());
    record.stages.push_back(std::move(*stage));
    for (RunObserver* observer : observers_) {
      if (auto ok = observer->OnStageEnd(record.stages.back()); !ok) {
        return tl::unexpected(ok.error());
      }
    }
    if (!record.stages.back().success) break;
  }
  record.actions = actions_;
  record.timing_ms = timing_.Percentiles();
  record.wall_s = (WallMs() - start_ms) * 1e-3;
  for (RunObserver* observer : observers_) {
    if (auto ok = observer->OnEpisodeEnd(agent_, record); !ok) return tl::unexpected(ok.error());
  }
  return record;
}

Result<void> EpisodeRun::WakeUp() {
  for (RunObserver* observer : observers_) {
    auto memory = observer->LostIn();
    if (!memory) return tl::unexpected(memory.error());
    if (*memory) return Localise(std::move(**memory));
  }
  return {};
}

/// The odometry starts at the robot's own foot and knows nothing of the map.
Result<void> EpisodeRun::Localise(store::LoadedMemory memory) {
  const agent::Config& config = config_.agent;
  auto awakening = localization::Awakening::In(
      memory.map, {config.sensor.camera_height_m, config.action, config.map});
  if (!awakening) return tl::unexpected(awakening.error());
  const Pose T_odom_world = localization::FootFrameOf(simulator_.agent()).inverse();
  T_agent_world_ = T_odom_world;
  Observation observation = Observe();
  while (awakening->Step(observation).status == localization::Status::kLocalising) {
    simulator_.Step(awakening->last().action);
    floors_->Move(simulator_.agent().p_world);
    ++actions_;
    observation = Observe();
  }
  Awoken awoken{awakening->last(), awakening->actions()};
  T_agent_world_ = awakening->T_agent_odom() * T_odom_world;
  if (awoken.answer.status == localization::Status::kKnown) {
    observation.T_world_camera = awakening->T_agent_odom() * observation.T_world_camera;
    const AgentPose said = FootPoseOf(observation, config.sensor.camera_height_m);
    const AgentPose& truth = simulator_.agent();
    awoken.off_m = (said.p_world - truth.p_world).norm();
    awoken.off_deg = std::abs(RadToDeg(WrapAngle(said.yaw_rad - truth.yaw_rad)));
    auto ok = agent_.Restore(std::move(memory.map), std::move(memory.memory),
                             std::move(memory.flights), memory.seen_stairs);
    if (!ok) return ok;
    agent_.RestoreObjects(std::move(memory.objects), static_cast<int>(memory.header.revision));
  } else {
    T_world_claims_ = T_odom_world.inverse();
  }
  for (RunObserver* observer : observers_) observer->OnAwoken(awoken);
  return {};
}

Observation EpisodeRun::Observe() {
  Observation observation = simulator_.Observe();
  observation.T_world_camera = T_agent_world_ * observation.T_world_camera;
  return observation;
}

Result<StageRecord> EpisodeRun::RunStage(const std::string& goal) {
  const auto picture = episode_.pictures.find(goal);
  const auto set = picture == episode_.pictures.end() ? agent_.SetGoal(goal)
                                                      : agent_.SetGoal(picture->second->picture);
  if (!set) return tl::unexpected(set.error());
  StageState stage(context_.navmesh().Floors());
  stage.actions_before = actions_;
  stage.record.goal = goal;
  stage.record.start_world = simulator_.agent().p_world;
  stage.record.floor_start = floors_->floor();
  floors_->StartStage();
  const auto shortest_m = context_.DistanceToGoalFromAbout(stage.record.start_world, goal);
  if (!shortest_m) {
    return Fail(ErrorCode::kInvalid,
                "goal \"" + goal + "\" cannot be reached from where its stage starts",
                episode_.where);
  }
  stage.record.shortest_m = *shortest_m;  // eq:posthoc_distance
  StageEnd end;
  while (HasBudget(stage.actions_before)) {
    const auto is_over = StepOnce(stage, end);
    if (!is_over) return tl::unexpected(is_over.error());
    if (*is_over) break;
  }
  end.recent_path_m = std::accumulate(recent_m_.begin(), recent_m_.end(), 0.0);
  FinishStage(end, stage);
  return std::move(stage.record);
}

Result<bool> EpisodeRun::StepOnce(StageState& stage, StageEnd& end) {
  Stopwatch watch;
  const Observation observation = Observe();
  const Stopwatch::Lap observed = watch.Next();
  auto step = agent_.Step(observation);
  if (!step) return tl::unexpected(step.error());
  const Stopwatch::Lap decided = watch.Next();
  stage.stairs.Add(step->trace);
  stage.cause.Add(step->trace, floors_->floor());
  NotePassing(stage);
  for (RunObserver* observer : observers_) {
    const StepView view{observation,        step->trace, step->timing,
                        simulator_.agent(), agent_,      step->percept};
    if (auto ok = observer->OnStep(view); !ok) return tl::unexpected(ok.error());
  }
  if (step->all_explored) {
    end.all_explored = true;
    return true;
  }
  ++actions_;
  watch.Next();
  if (step->action == Action::kStop) {
    end.stopped = true;
    end.is_reached = IsGoalReached(context_, context_.TargetsOf(stage.record.goal),
                                   simulator_.agent().p_world, config_.eval);
    const std::optional<Vector3d> p_claimed =
        step->p_claimed_world ? std::optional<Vector3d>(T_world_claims_ * *step->p_claimed_world)
                              : std::nullopt;
    if (MeansOneInstance(stage.record.goal))
      end.is_reached = end.is_reached && p_claimed && IsClaimOf(stage.record.goal, *p_claimed);
    end.is_claim_near = p_claimed && IsClaimNear(stage.record.goal, *p_claimed);
  } else {
    Move(step->action, stage);
  }
  const Stopwatch::Lap moved = watch.Next();
  timing_.Add(step->timing);
  AddCost({observed.wall_ms + decided.wall_ms + moved.wall_ms,
           observed.cpu_ms + decided.cpu_ms + moved.cpu_ms, observed.wall_ms + moved.wall_ms,
           observed.cpu_ms + moved.cpu_ms});
  return end.stopped;
}

void EpisodeRun::AddCost(const StepCost& cost) {
  timing_.Add("simulator", cost.observe_cpu_ms);
  timing_.Add("step", cost.cpu_ms);
  for (RunObserver* observer : observers_) observer->OnStepCost(cost);
}

void EpisodeRun::Move(Action action, StageState& stage) {
  const Vector3d before = simulator_.agent().p_world;
  simulator_.Step(action);
  const double moved_m = (simulator_.agent().p_world - before).norm();
  stage.record.length_m += moved_m;
  stage.walk.Add(action, simulator_.agent().p_world, moved_m);
  recent_m_.push_back(moved_m);
  while (static_cast<int>(recent_m_.size()) > config_.eval.stuck_steps) recent_m_.pop_front();
  const int floor_before = floors_->floor();
  floors_->Move(simulator_.agent().p_world);
  if (floors_->floor() != floor_before) stage.cause.Arrive(floor_before, floors_->floor());
}

/// Notes whether a true instance was in view and within the success radius.
void EpisodeRun::NotePassing(StageState& stage) const {
  if (stage.was_in_view) return;
  const Vector3d& p_world = simulator_.agent().p_world;
  const int floor = context_.navmesh().FloorOf(p_world);
  for (const Target& target : context_.TargetsOf(stage.record.goal)) {
    if (!IsWithinBoxRadius(target, p_world, floor, config_.eval)) continue;
    const auto& pixels = simulator_.last_frame().instance.data;
    const auto visible_px = std::count(pixels.begin(), pixels.end(), target.instance);
    stage.was_in_view = stage.was_in_view || visible_px >= config_.eval.seen_px;
  }
}

bool EpisodeRun::IsClaimNear(const std::string& goal, const Vector3d& p_claimed_world) const {
  const int floor = context_.FloorUnder(p_claimed_world);
  for (const Target& target : context_.TargetsOf(goal)) {
    if (IsWithinBoxRadius(target, p_claimed_world, floor, config_.eval)) return true;
  }
  return false;
}

/// An object beside the described or pictured object is a wrong object.
bool EpisodeRun::IsClaimOf(const std::string& goal, const Vector3d& p_claimed_world) const {
  constexpr double kAtBox_m = 0.3;  // chosen: three voxels
  const auto& targets = context_.TargetsOf(goal);
  return std::any_of(targets.begin(), targets.end(), [&](const Target& target) {
    return target.box.HorizontalDistance(p_claimed_world) <= kAtBox_m &&
           p_claimed_world.z() >= target.box.min.z() - kAtBox_m &&
           p_claimed_world.z() <= target.box.max.z() + kAtBox_m;
  });
}

void EpisodeRun::FinishStage(const StageEnd& end, StageState& stage) const {
  StageRecord& record = stage.record;
  record.outcome = JudgeStage(end, config_.eval);
  record.success = record.outcome == Outcome::kSuccess;
  record.end_world = simulator_.agent().p_world;
  record.floor_end = floors_->floor();
  record.transitions = floors_->transitions();
  record.actions = actions_ - stage.actions_before;
  record.extra.walk = stage.walk.Finish(context_, record, config_.eval);
  record.extra.passed_target = stage.was_in_view && !record.success;
  record.extra.wrong_floor =
      !record.success && IsOnWrongFloor(context_.TargetsOf(record.goal), record.end_world,
                                        context_.navmesh().FloorOf(record.end_world), config_.eval);
  const auto floors = context_.FloorsOf(record.goal);
  const bool needs_stairs =
      std::find(floors.begin(), floors.end(), record.floor_start) == floors.end();
  if (!record.success && needs_stairs) {
    record.extra.stairs = stage.stairs.Verdict(record.transitions);
  }
  record.extra.distance_to_goal_m = context_.DistanceToGoalFromAbout(record.end_world, record.goal);
  if (!record.success) {
    record.extra.cause = JudgeCause(stage.cause, context_, agent_.map(), record);
  }
}

}  // namespace

Result<EpisodeRecord> RunEpisode(const SceneContext& context, const Episode& episode,
                                 const RunConfig& config, std::span<RunObserver* const> observers,
                                 const MakePerception& make_perception) {
  if (config.eval.perception != "oracle" && !make_perception) {
    return Fail(ErrorCode::kUnsupported,
                "perception from " + config.eval.perception + " is not available here",
                "eval.perception");
  }
  sim::Simulator simulator(context.scene(), context.navmesh(), context.caster(),
                           config.agent.sensor, config.agent.action);
  simulator.UseNoise(config.noise, HashString(episode.episode_id));
  auto perception = make_perception ? make_perception(simulator)
                                    : sim::GroundTruthPerception(simulator, config.ground_truth,
                                                                 KnownPicturesOf(episode));
  if (!perception) return tl::unexpected(perception.error());
  agent::Agent agent(config.agent, std::move(*perception));
  return EpisodeRun(context, episode, config, simulator, agent).Run(observers);
}

}  // namespace crossnav::evaluation
