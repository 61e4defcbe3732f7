// SPDX-License-Identifier: MIT
#include "crossnav/agent/agent.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "crossnav/agent/behaviour.h"
#include "crossnav/agent/state.h"
#include "crossnav/agent/targets.h"
#include "crossnav/core/check.h"
#include "crossnav/policy/stair_geometry.h"

namespace crossnav::agent {

using policy::Mode;
using policy::ModeDecision;
using policy::ModeInputs;

namespace {

constexpr double kOtherLevel_m = 0.5;  // chosen: more than the level band

/// CPU time between calls, for StepResult::timing.
class StageClock {
 public:
  explicit StageClock(std::vector<trace::StageTime>& times) : times_(times), last_(Now()) {}
  void Stop(const char* stage) {
    const double now = Now();
    times_.push_back({stage, now - last_});
    last_ = now;
  }

 private:
  static double Now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
  }
  std::vector<trace::StageTime>& times_;
  double last_;
};

Result<void> CheckObservation(const Observation& obs) {
  if (!IsValidPose(obs.T_world_camera))
    return Fail(ErrorCode::kInvalid, "the camera pose is not a finite rigid transform",
                "observation.T_world_camera");
  const bool has_sizes = obs.depth_m.width == obs.camera.width_px &&
                         obs.depth_m.height == obs.camera.height_px &&
                         obs.rgb.width == obs.depth_m.width && obs.rgb.height == obs.depth_m.height;
  if (!has_sizes || obs.depth_m.empty())
    return Fail(ErrorCode::kInvalid, "colour, depth and intrinsics must have one size",
                "observation.depth_m");
  return {};
}

/// What the candidates of this step are, each with its plan.
struct Options {
  std::optional<Target> live, history, exploration, stair;
  int live_id = -1, history_index = -1;
  std::vector<policy::Candidate> shown;
};

/// eq:supp_candidate_set. Only classes that could be chosen now are planned for.
Options CollectCandidates(Situation& now) {
  Options options;
  if (now.goal.session) {
    if (now.goal.script.empty()) options.stair = ChooseStairFrontier(now);
    if (options.stair) options.shown.push_back(options.stair->candidate);
    return options;
  }
  options.live = ChooseLivePoi(now, &options.live_id);
  options.history = ChooseHistoryPoi(now, &options.history_index);
  if (!options.live && !options.history && !now.goal.entrance && now.goal.script.empty())
    options.exploration = ChooseExploration(now, &options.shown);
  if (options.history) options.shown.insert(options.shown.begin(), options.history->candidate);
  if (options.live) options.shown.insert(options.shown.begin(), options.live->candidate);
  return options;
}

ModeInputs InputsFor(const Situation& now, const Options& options, SessionVerdict session,
                     EntranceVerdict entrance) {
  ModeInputs in;
  in.mode = now.goal.mode;
  in.is_new_goal = now.goal.is_new;
  in.entrance_verified = entrance == EntranceVerdict::kVerified;
  in.session_on_landing = session == SessionVerdict::kLandingReached;
  in.session_failed = session == SessionVerdict::kFailed;
  in.has_live_poi = options.live.has_value();
  in.has_history_poi = options.history.has_value();
  in.is_following_history = now.goal.active_history >= 0;
  if (options.live && options.history) {
    const Vector3d d =
        options.live->candidate.p_focus_world - options.history->candidate.p_focus_world;
    in.live_near_history = d.norm() <= now.config.policy.poi.live_takeover_m;
  }
  in.is_near_viewpoint =
      options.live && options.live->plan.cost * now.config.map.voxel_m <= 1.0;  // chosen
  return in;
}

/// What later stages need of a frame.
struct Seen {
  std::vector<policy::Sighting> sightings;
  int detections = 0;
};

trace::CandidateTrace Describe(const policy::Candidate& candidate, double voxel_m) {
  trace::CandidateTrace t;
  t.kind = NameOf(candidate.kind);
  t.p_focus_world = candidate.p_focus_world;
  if (!candidate.standing.empty())
    t.p_nav_world = CenterOf(candidate.standing[candidate.standing.size() / 2], voxel_m);
  t.score = candidate.score;
  t.size = candidate.size;
  return t;
}

}  // namespace

struct Agent::Impl {
  Config config;
  perception::PerceptionSuite perception;
  World world;
  GoalState goal;
  policy::BumpMonitor bumps;
  std::vector<geometry::StateChange> changes;

  Impl(const Config& c, perception::PerceptionSuite p)
      : config(c), perception(std::move(p)), world(c) {}

  Result<Seen> See(const Observation& obs, const AgentPose& agent, StageClock& clock);
  void UpdateMap();
  void UpdateLevel(const AgentPose& agent);
  void NoticeBump(const AgentPose& agent);
  void ApplyMode(const ModeDecision& next, const Options& options);
  const std::optional<Target>& SelectTarget(const ModeDecision& next, const Options& options) const;
  std::optional<Action> Act(Situation& now, const ModeDecision& next,
                            const std::optional<Target>& target,
                            const policy::Verification& verification);
  bool Reconsider(Situation& now);
  void Record(StepResult& result, const ModeDecision& next, const Options& options,
              const std::optional<Target>& target, const policy::Verification& verification);
};

void Agent::Impl::UpdateMap() {
  const auto& fresh = world.map.UpdateStates();
  changes.insert(changes.end(), fresh.begin(), fresh.end());
}

void Agent::Impl::UpdateLevel(const AgentPose& agent) {
  if (!world.has_level) {
    world.has_level = true;
    world.level_m = agent.p_world.z();
    goal.p_looked_around_world = agent.p_world;
    QueueLookAround(goal, agent, config.action);
    return;
  }
  if (goal.session || std::abs(agent.p_world.z() - world.level_m) < kOtherLevel_m) return;
  if (!policy::IsFlatAround(world.map, agent.p_world)) return;
  world.level_m = agent.p_world.z();
  goal.commitment.reset();
  goal.events.push_back("on another level");
}

void Agent::Impl::NoticeBump(const AgentPose& agent) {
  if (!bumps.Update(agent, world.step, config.map)) return;
  goal.events.push_back("bump");
  if (bumps.bumps_in_place() < 3) return;  // chosen: two tries, then another way out
  const auto escape = policy::EscapeActions(world.map, agent, bumps.bumped_yaws(), config.action);
  goal.script.assign(escape.begin(), escape.end());
  goal.events.push_back("stuck: stepping aside");
}

void Agent::Impl::ApplyMode(const ModeDecision& next, const Options& options) {
  const bool is_poi = next.mode == Mode::kPoiNavigation || next.mode == Mode::kTargetApproach;
  if (is_poi) {
    goal.script.clear();
    goal.entrance.reset();
    goal.commitment.reset();
  }
  const int live = is_poi && next.uses_live_poi ? options.live_id : -1;
  if (live != goal.active_live) {
    goal.tried_viewpoints.clear();
    goal.failed_views = 0;
  }
  goal.active_live = live;
  goal.active_history = is_poi && !next.uses_live_poi ? options.history_index : -1;
  if (next.mode != goal.mode) goal.events.push_back("mode: " + std::string(NameOf(next.mode)));
  goal.mode = next.mode;
  goal.is_new = false;
}

const std::optional<Target>& Agent::Impl::SelectTarget(const ModeDecision& next,
                                                       const Options& options) const {
  switch (next.mode) {
    case Mode::kStairExplore:
      return options.stair;
    case Mode::kPoiNavigation:
      return next.uses_live_poi ? options.live : options.history;
    case Mode::kTargetApproach:
      return options.live;
    case Mode::kBasicExplore:
      break;
  }
  return options.exploration;
}

std::optional<Action> Agent::Impl::Act(Situation& now, const ModeDecision& next,
                                       const std::optional<Target>& target,
                                       const policy::Verification& verification) {
  if (next.mode == Mode::kStairExplore) return Climb(now, target);
  if (!goal.script.empty()) {
    const Action scripted = goal.script.front();
    goal.script.pop_front();
    return scripted;
  }
  if (!target) return std::nullopt;
  if (next.mode == Mode::kBasicExplore) return Explore(now, *target);
  if (!next.uses_live_poi) return VisitHistoryPoi(now, *target);
  return Approach(now, *target, *goal.live.Find(goal.active_live), verification);
}

/// Nothing to go to: what may have been overlooked, from cheap to dear. False when all is done.
bool Agent::Impl::Reconsider(Situation& now) {
  if (!bumps.obstacles().empty()) {
    bumps.Clear();
    goal.events.push_back("temporary obstacles forgotten");
    return true;
  }
  return LookAroundOnce(now) || Relax(now);
}

Agent::Agent(const Config& config, perception::PerceptionSuite perception)
    : impl_(std::make_unique<Impl>(config, std::move(perception))) {}
Agent::~Agent() = default;
Agent::Agent(Agent&&) noexcept = default;

const Config& Agent::config() const {
  return impl_->config;
}
const geometry::VoxelMap& Agent::map() const {
  return impl_->world.map;
}
const memory::SemanticMemory& Agent::memory() const {
  return impl_->world.memory;
}

Result<void> Agent::SetGoal(const std::string& name) {
  auto text = impl_->perception.encoder->EncodeText(name);
  if (!text) return tl::unexpected(text.error());
  GoalState fresh;
  fresh.goal = name;
  fresh.index = impl_->goal.index + 1;
  fresh.text = std::move(*text);
  if (impl_->config.query.relevancy == "contrastive") {
    auto background =
        perception::EncodeTexts(*impl_->perception.encoder, memory::kBackgroundPrompts);
    if (!background) return tl::unexpected(background.error());
    fresh.background = std::move(*background);
  }
  fresh.events.push_back("goal activated: " + name);
  fresh.history = RememberedPlaces(impl_->world, fresh, impl_->config);
  impl_->goal = std::move(fresh);
  impl_->bumps.Clear();
  return {};
}

Result<void> Agent::Restore(geometry::VoxelMap map, memory::SemanticMemory memory) {
  World& world = impl_->world;
  CROSSNAV_CHECK(world.step == 0, "a saved memory is given before the first step");
  if (map.config().voxel_m != impl_->config.map.voxel_m)
    return Fail(ErrorCode::kMismatch, "the saved map has another voxel size than map.voxel_m",
                "memory");
  if (memory.Dim() != 0 && memory.Dim() != impl_->perception.encoder->Dim())
    return Fail(ErrorCode::kMismatch, "the saved features have another dimension than the encoder",
                "memory");
  world.map = std::move(map);
  world.memory = std::move(memory);
  return {};
}

/// Everything that one frame adds to the world, in the paper's order.
Result<Seen> Agent::Impl::See(const Observation& obs, const AgentPose& agent, StageClock& clock) {
  auto percept = perception.Look(obs, goal.goal);  // boxes, masks, stair pixels, dense features
  if (!percept) return tl::unexpected(percept.error());
  clock.Stop("perceive");

  // Sec. "RGB-D Projection and Sparse Voxelization", then eq:supp_support_classification.
  const auto& end_voxels = world.map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
  world.map.ObserveBody(agent.p_world, config.sensor.camera_height_m);
  clock.Stop("integrate");
  UpdateMap();
  clock.Stop("classify");

  // eq:intra_frame_fusion, eq:supp_feature_fusion.
  const auto& grid = percept->features;
  world.memory.Fuse(end_voxels, obs.depth_m, obs.camera, obs.T_world_camera,
                    {grid.rows, grid.cols, grid.dim, grid.data});
  clock.Stop("fuse");

  // Evidence only; nothing is promoted outside a session (sec. "Stair-State Promotion").
  if (!config.policy.planar) {
    world.stairs.Update(percept->stair_probability, end_voxels, world.map, config.policy.stair,
                        world.step);
  }
  auto sightings =
      policy::LiftDetections(percept->detections, obs, config.map, config.policy.object,
                             config.policy.object.secondary_confidence);
  goal.live.Update(sightings, config.policy.object, config.map.voxel_m, world.step);
  NoticeBump(agent);
  UpdateLevel(agent);
  clock.Stop("evidence");
  return Seen{std::move(sightings), static_cast<int>(percept->detections.size())};
}

Result<StepResult> Agent::Step(const Observation& obs) {
  if (auto ok = CheckObservation(obs); !ok) return tl::unexpected(ok.error());
  Impl& self = *impl_;
  GoalState& goal = self.goal;
  const double camera_m = self.config.sensor.camera_height_m;
  const AgentPose agent = AgentPoseOf(obs.T_world_camera, camera_m);
  StepResult result;
  StageClock clock(result.timing);
  self.changes.clear();

  const auto seen = self.See(obs, agent, clock);  // map, memory, evidence
  if (!seen) return tl::unexpected(seen.error());

  const auto start = planner::StartVoxel(self.world.map, agent.p_world);
  Situation now{self.config, self.world, goal, agent, start, &self.bumps.obstacles()};
  std::optional<Action> look;
  const SessionVerdict session = CheckSession(now);
  const EntranceVerdict entrance = CheckEntrance(now, &look);
  self.UpdateMap();
  const Options options = CollectCandidates(now);  // eq:supp_candidate_set
  const ModeDecision next = NextMode(InputsFor(now, options, session, entrance));  // pure
  self.ApplyMode(next, options);
  clock.Stop("candidates");

  const auto& target = self.SelectTarget(next, options);  // eq:supp_candidate_priority
  policy::Verification verification;
  if (next.uses_live_poi) {
    verification = policy::Verify(*goal.live.Find(goal.active_live), seen->sightings, obs,
                                  self.config.policy, camera_m, self.config.map.voxel_m);
  }
  const bool is_looking = look && next.mode == Mode::kBasicExplore;
  const auto action = is_looking ? look : self.Act(now, next, target, verification);
  if (!action) result.all_explored = !self.Reconsider(now);
  result.action = action.value_or(Action::kTurnLeft);
  if (next.uses_live_poi && result.action == Action::kStop)
    result.p_claimed_world = goal.live.Find(goal.active_live)->p_center_world;
  self.bumps.Commit(result.action, agent);
  clock.Stop("act");

  self.Record(result, next, options, target, verification);
  result.trace.agent = agent;
  result.trace.T_world_camera = obs.T_world_camera;
  result.trace.detections = seen->detections;
  ++self.world.step;
  return result;
}

void Agent::Impl::Record(StepResult& result, const ModeDecision& next, const Options& options,
                         const std::optional<Target>& target,
                         const policy::Verification& verification) {
  trace::StepTrace& t = result.trace;
  t.step = world.step;
  t.goal_index = goal.index;
  t.goal = goal.goal;
  t.action = result.action;
  t.mode = NameOf(next.mode);
  t.reason = NameOf(next.reason);
  t.level_m = world.level_m;
  t.all_explored = result.all_explored;
  for (const policy::Candidate& candidate : options.shown) {
    auto described = Describe(candidate, config.map.voxel_m);
    if (target && candidate.kind == target->candidate.kind &&
        candidate.p_focus_world == target->candidate.p_focus_world) {
      described.is_target = true;
      described.path_cost = target->plan.cost;
      described.p_nav_world = CenterOf(target->plan.path.back(), config.map.voxel_m);
    }
    t.candidates.push_back(std::move(described));
  }
  if (target) {
    for (const auto& key : target->plan.path)
      t.path_world.push_back(CenterOf(key, config.map.voxel_m));
  }
  t.verification = {next.uses_live_poi,      verification.passed,
                    verification.confidence, verification.mask_quality,
                    verification.visibility, RadToDeg(verification.view_angle_rad),
                    verification.distance_m, next.uses_live_poi ? verification.failed_check : ""};
  t.events = std::exchange(goal.events, {});
  const memory::MemoryCounters counters = world.memory.Counters();
  t.memory = {world.memory.Size(), counters.compacted_rows, counters.dropped_rows};
  t.voxel_changes = std::move(changes);
}

}  // namespace crossnav::agent
