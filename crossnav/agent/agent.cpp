// SPDX-License-Identifier: MIT
#include "crossnav/agent/agent.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "crossnav/agent/claims.h"
#include "crossnav/agent/closed_way.h"
#include "crossnav/agent/decision.h"
#include "crossnav/agent/navigator.h"
#include "crossnav/agent/object_notes.h"
#include "crossnav/agent/observation_check.h"
#include "crossnav/agent/onemap_policy.h"
#include "crossnav/agent/paper_policy.h"
#include "crossnav/agent/passing_sights.h"
#include "crossnav/agent/planar.h"
#include "crossnav/agent/remembered_places.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/agent/whereabouts.h"
#include "crossnav/core/check.h"
#include "crossnav/core/colour_grid.h"

namespace crossnav::agent {

namespace {

constexpr float kOldWeight = 1;  // chosen: yesterday's views count as one view from near

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

/// Outputs of a frame that later stages need.
struct Seen {
  std::vector<policy::Sighting> sightings;
  perception::Percept percept;
};

/// Settings of hints: every sighting counts, however small or doubtful.
policy::ObjectConfig HintConfig(const policy::PolicyConfig& policy) {
  policy::ObjectConfig config = policy.object;
  config.detector_confidence = policy.explore.hint_confidence;
  config.min_box_area_fraction = 0;
  return config;
}

}  // namespace

struct Agent::Impl {
  const Config given;
  Config config;  // of this step: of the profile, with the height of the camera as it is mounted
  perception::PerceptionSuite perception;
  Hooks* hooks;
  World world;
  GoalState goal;
  std::vector<geometry::StairFlight> traced_flights;  // as in the last record that has them

  Impl(const Config& c, perception::PerceptionSuite p, Hooks* h)
      : given(c), config(OfProfile(c)), perception(std::move(p)), hooks(h), world(c) {}

  Result<void> Begin(GoalState fresh);
  Result<Seen> See(const Observation& obs, const AgentPose& agent, StageClock& clock);
  std::vector<policy::Sighting> Lift(const std::vector<perception::Detection>& detections,
                                     const Observation& obs);
  std::vector<policy::Sighting> NoteSightings(std::vector<policy::Sighting> sightings,
                                              const std::vector<policy::Sighting>& all,
                                              const Observation& obs);
  void Record(StepResult& result, const Decision& decision);
};

Agent::Agent(const Config& config, perception::PerceptionSuite perception, Hooks* hooks)
    : impl_(std::make_unique<Impl>(config, std::move(perception), hooks)) {
  CROSSNAV_CHECK(!hooks || config.policy.profile == "full", "hooks are for policy.profile = full");
}
Agent::~Agent() = default;
Agent::Agent(Agent&&) noexcept = default;

const Config& Agent::config() const {
  return impl_->given;
}
const geometry::VoxelMap& Agent::map() const {
  return impl_->world.map;
}
const memory::SemanticMemory& Agent::memory() const {
  return impl_->world.memory;
}

const std::vector<geometry::StairFlight>& Agent::flights() const {
  return impl_->world.flights;
}

std::span<const float> Agent::goal_text() const {
  return impl_->goal.text;
}

std::vector<geometry::SeenStair> Agent::seen_stairs() const {
  return impl_->world.stairs.Export();
}

Result<void> Agent::SetGoal(const std::string& wish) {
  auto described = DescribedGoalOf(wish, *impl_->perception.encoder);
  if (!described) return tl::unexpected(described.error());
  GoalState fresh;
  fresh.goal = *described ? (*described)->category : wish;
  fresh.described = std::move(*described);
  fresh.events.push_back("goal activated: " + wish);
  return impl_->Begin(std::move(fresh));
}

Result<void> Agent::SetGoal(const perception::GoalPicture& picture) {
  auto pictured = PicturedGoalOf(picture, impl_->perception);
  if (!pictured) return tl::unexpected(pictured.error());
  GoalState fresh;
  fresh.goal = pictured->category;
  fresh.events.push_back("goal activated: " + pictured->name + ", of a " + pictured->category);
  fresh.pictured = std::move(*pictured);
  return impl_->Begin(std::move(fresh));
}

/// Starts the search; `fresh` has the goal, and nothing of its search yet.
Result<void> Agent::Impl::Begin(GoalState fresh) {
  auto text = perception.encoder->EncodeText(fresh.goal);
  if (!text) return tl::unexpected(text.error());
  LearnNames(*perception.encoder, config, &world);
  LearnDoors(*perception.encoder, &world);
  fresh.index = goal.index + 1;
  fresh.begun_step = world.step;
  fresh.text = std::move(*text);
  if (config.query.relevancy == "contrastive") {
    auto background = perception::EncodeTexts(*perception.encoder, memory::kBackgroundPrompts);
    if (!background) return tl::unexpected(background.error());
    fresh.background = std::move(*background);
  }
  LookAtHome(world, config, &fresh);
  fresh.history = RememberedPlaces(world, fresh, config);
  goal = std::move(fresh);
  world.full.asked.insert(goal.goal);
  goal.full.inspect_range_m = config.policy.explore.inspect_range_m;
  world.full.field.BeginGoal();
  world.paper.bumps.Clear();
  world.onemap.map.ClearChecked();
  // Inspected ground needs no second look because the memory answers for it. Without History POIs
  // nothing answers, so that a new goal inspects all ground again, unless keep_coverage is set.
  const policy::PoiConfig& poi = config.policy.poi;
  if (!poi.use_history && !poi.keep_coverage) world.coverage.Clear();
  return {};
}

Result<void> Agent::Restore(geometry::VoxelMap map, memory::SemanticMemory memory,
                            std::vector<geometry::StairFlight> flights,
                            const std::vector<geometry::SeenStair>& seen_stairs) {
  World& world = impl_->world;
  CROSSNAV_CHECK(world.step == 0, "a saved memory is given before the first step");
  if (map.config().voxel_m != impl_->config.map.voxel_m)
    return Fail(ErrorCode::kMismatch, "the saved map has another voxel size than map.voxel_m",
                "memory");
  if (memory.Dim() != 0 && memory.Dim() != impl_->perception.encoder->Dim())
    return Fail(ErrorCode::kMismatch, "the saved features have another dimension than the encoder",
                "memory");
  world.map = std::move(map);
  if (ClearsOldSurfaces(impl_->config))
    if (auto done = CountEvidence(&world.map); !done) return done;
  world.ground.Rebuild(world.map);
  world.memory = std::move(memory);
  if (ClearsOldSurfaces(impl_->config)) world.memory.LimitWeights(kOldWeight);
  world.flights = std::move(flights);
  world.stairs.Import(seen_stairs);
  if (IsRevising(impl_->config)) world.revision = RevisionOf(world);
  for (const geometry::StairFlight& flight : world.flights) {
    if (!flight.IsWalked()) continue;
    for (std::size_t i = 1; i < flight.steps_world.size(); ++i)
      world.ground.NoteStep(flight.steps_world[i - 1], flight.steps_world[i]);
    for (const Vector3d& p_end : {flight.p_foot_world, flight.p_top_world})
      world.levels_m.push_back(p_end.z());
  }
  return {};
}

void Agent::RestoreObjects(std::vector<objects::ObjectRecord> records, int day) {
  World& world = impl_->world;
  CROSSNAV_CHECK(world.step == 0, "a saved memory is given before the first step");
  world.objects.Load(std::move(records));
  world.has_loaded_objects = true;
  world.day = day;
  LocateObjects(&world);
}

std::vector<objects::ObjectRecord> Agent::objects() const {
  return impl_->world.objects.Confirmed();
}

std::span<const objects::ObjectRecord> Agent::records() const {
  return impl_->world.objects.records();
}

/// The goal in 3D; as weak as a hint may be.
std::vector<policy::Sighting> Agent::Impl::Lift(
    const std::vector<perception::Detection>& detections, const Observation& obs) {
  const policy::ObjectConfig object = SightingRules(config);
  const double least =
      std::min(object.secondary_confidence, HintConfig(config.policy).detector_confidence);
  return policy::LiftDetections(detections, obs, config.map, object, least);
}

/// Live POIs (sec. "Candidate Navigation Points") and hints of the goal; sightings below the
/// confidence of a POI become hints and are not returned. `all`: those of rejected objects, too,
/// whose views go on to count.
std::vector<policy::Sighting> Agent::Impl::NoteSightings(std::vector<policy::Sighting> sightings,
                                                         const std::vector<policy::Sighting>& all,
                                                         const Observation& obs) {
  const policy::ObjectConfig& object = config.policy.object;
  const Vector3d p_camera_world = obs.T_world_camera.translation();
  goal.full.hints.Update(sightings, HintConfig(config.policy), config.map.voxel_m, world.step);
  const std::vector<policy::Sighting> kept = sightings;
  std::erase_if(sightings, [&](const policy::Sighting& sighting) {
    return sighting.confidence < object.secondary_confidence;
  });
  // Paper, "Final Target-Object Approach": during the approach the detection is updated.
  const int approached = config.policy.profile == "paper" ? goal.active_live : -1;
  goal.live.Update(sightings, object, config.map.voxel_m, world.step, approached);
  if (config.policy.profile == "full") {
    goal.live.DropStrays(sightings, obs, object, config.map.voxel_m);
    goal.full.hints.DropStrays(kept, obs, object, config.map.voxel_m);
  }
  if (DoubtsClaims(config)) {
    const policy::VerifyConfig& verify = config.verify;
    NoteViews(goal.live.all(), sightings, p_camera_world, object, verify, &goal.full.claims);
    if (verify.evidence == "views") {
      NoteScores(goal.live.all(), all, obs, config.map.voxel_m, object, verify, &goal.full.claims);
      NoteScores(HintsInSight(goal.full.hints, obs, config), kept, obs, config.map.voxel_m, object,
                 verify, &goal.full.hint_views);
    }
  }
  return sightings;
}

/// Updates the world by one frame, in the paper's order.
Result<Seen> Agent::Impl::See(const Observation& obs, const AgentPose& agent, StageClock& clock) {
  auto percept = perception.Look(obs, goal.goal);  // boxes, masks, stair pixels, dense features
  if (!percept) return tl::unexpected(percept.error());
  if (auto ok = CheckPercept(*percept, obs); !ok) return tl::unexpected(ok.error());
  clock.Stop("perceive");

  // Sec. "RGB-D Projection and Sparse Voxelization", then eq:supp_support_classification.
  const auto& end_voxels = world.map.Integrate(obs.depth_m, obs.camera, obs.T_world_camera);
  world.map.ObserveBody(agent.p_world, config.sensor.camera_height_m);
  clock.Stop("integrate");
  world.UpdateStates();
  if (world.full.before_forward)
    world.ground.NoteStep(world.full.before_forward->p_world, agent.p_world);
  if (config.policy.profile == "full")
    for (const auto& key : world.full.unanswered.Look(obs, agent.p_world, world.map))
      world.ground.NoteUnanswered(key);
  clock.Stop("classify");

  // eq:intra_frame_fusion, eq:supp_feature_fusion.
  const auto& grid = percept->features;
  const double level_m = world.has_level ? world.level_m : agent.p_world.z();
  const std::vector<geometry::EndRun> planar =
      config.policy.planar ? CollapsedOn(level_m, end_voxels, config.map.voxel_m)
                           : std::vector<geometry::EndRun>{};
  world.memory.FuseRuns(config.policy.planar ? planar : end_voxels.runs(), obs.depth_m, obs.camera,
                        obs.T_world_camera, {grid.rows, grid.cols, grid.dim, grid.data});
  clock.Stop("fuse");

  // Evidence only; nothing is promoted outside a session (sec. "Stair-State Promotion").
  if (!config.policy.planar) {
    world.stairs.Update(percept->stair_probability, end_voxels.runs(), world.map,
                        config.policy.stair, world.step);
    world.flight_survey.Update(world.stairs, world.levels_m, agent.p_world, config.map.voxel_m,
                               &world.flights);
  }
  const auto all = Lift(percept->detections, obs);
  const auto lifted = WithoutRejected(all, obs.T_world_camera.translation(), world, config, &goal);
  auto sightings = NoteSightings(lifted, all, obs);
  const Vector3d p_camera_world = obs.T_world_camera.translation();
  FullGoal& full = goal.full;
  const double voxel_m = config.map.voxel_m;
  world.coverage.Add(end_voxels, p_camera_world, full.inspect_range_m, voxel_m);
  if (config.policy.profile == "onemap") world.onemap.map.Add(end_voxels, obs, config.fusion);
  clock.Stop("evidence");
  std::vector<PassingSight> passing;
  if (NoticesThings(config)) {
    auto looked = LookInPassing(perception, obs, config, goal.goal, &world);
    if (!looked) return tl::unexpected(looked.error());
    passing = std::move(*looked);
  }
  NoteObjects({goal.goal, percept->detections, lifted}, passing, obs, &world, &goal);
  clock.Stop("objects");
  return Seen{std::move(sightings), std::move(*percept)};
}

Result<StepResult> Agent::Step(const Observation& given) {
  if (auto ok = CheckObservation(given); !ok) return tl::unexpected(ok.error());
  Impl& self = *impl_;
  StepResult result;
  StageClock clock(result.timing);
  std::optional<Observation> registered;
  if (HasOwnColourGrid(given)) {
    registered = WithColourOnDepthGrid(given);
    clock.Stop("register");
  }
  const Observation& obs = registered ? *registered : given;
  const double height_m = CameraHeightOf(obs, self.given.sensor.camera_height_m);
  self.config.sensor.camera_height_m = height_m;
  const AgentPose agent = FootPoseOf(obs, height_m);
  const AgentPose eye = AgentPoseOf(obs.T_world_camera, height_m);
  self.world.changes.clear();

  auto seen = self.See(obs, agent, clock);  // map, memory, evidence
  if (!seen) return tl::unexpected(seen.error());

  // Candidates, mode and target, plan, action.
  StepState now{self.config, self.world, self.goal, agent, eye, obs, seen->sightings, self.hooks};
  const std::string& profile = self.config.policy.profile;
  const Decision decision = profile == "paper"    ? paper::Decide(now)
                            : profile == "onemap" ? onemap::Decide(now)
                                                  : Navigate(now);
  clock.Stop("decide");

  result.all_explored = !decision.action;
  result.action = decision.action.value_or(Action::kTurnLeft);
  result.p_claimed_world = decision.p_claimed_world;
  self.Record(result, decision);
  result.trace.agent = agent;
  result.trace.T_world_camera = obs.T_world_camera;
  result.trace.detections = static_cast<int>(seen->percept.detections.size());
  result.percept = std::move(seen->percept);
  ++self.world.step;
  return result;
}

void Agent::Impl::Record(StepResult& result, const Decision& decision) {
  trace::StepTrace& t = result.trace;
  t.step = world.step;
  t.goal_index = goal.index;
  t.goal = goal.goal;
  t.action = result.action;
  t.mode = NameOf(decision.mode.mode);
  t.reason = NameOf(decision.mode.reason);
  t.activity = decision.activity;
  t.level_m = world.level_m;
  t.all_explored = result.all_explored;
  for (const policy::Candidate& candidate : decision.shown) {
    auto described = TraceOf(candidate, config.map.voxel_m);
    if (decision.target && candidate.kind == decision.target->kind &&
        candidate.p_focus_world == decision.target->p_focus_world) {
      described.is_target = true;
      described.path_cost = decision.path_cost;
      if (!decision.path.empty())
        described.p_nav_world = CenterOf(decision.path.back(), config.map.voxel_m);
    }
    t.candidates.push_back(std::move(described));
  }
  for (const auto& key : decision.path) t.path_world.push_back(CenterOf(key, config.map.voxel_m));
  const policy::Verification& verification = decision.verification;
  const bool is_live = decision.mode.uses_live_poi;
  t.verification = {is_live,
                    verification.passed,
                    verification.confidence,
                    verification.mask_quality,
                    verification.visibility,
                    RadToDeg(verification.view_angle_rad),
                    verification.distance_m,
                    is_live ? verification.failed_check : ""};
  t.events = std::exchange(goal.events, {});
  if (world.flights != traced_flights) t.flights = traced_flights = world.flights;
  const memory::MemoryCounters counters = world.memory.Counters();
  t.memory = {world.memory.Size(), counters.compacted_rows, counters.dropped_rows};
  t.voxel_changes = std::move(world.changes);
}

}  // namespace crossnav::agent
