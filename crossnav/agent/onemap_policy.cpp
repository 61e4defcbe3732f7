// SPDX-License-Identifier: MIT
#include "crossnav/agent/onemap_policy.h"

#include <algorithm>

#include "crossnav/agent/paper_behaviour.h"
#include "crossnav/agent/paper_targets.h"
#include "crossnav/policy/frontiers.h"

namespace crossnav::agent::onemap {

using geometry::VoxelKey;
using paper::Target;
using policy::Candidate;
using policy::CandidateKind;
using policy::Column;
using policy::Mode;
using policy::ModeReason;
using policy::OneMapGoal;

namespace {

constexpr double kFrontierReach_m = 0.2, kPoiReach_m = 0.4;  // chosen: two columns, and four

/// Places to stand within `reach_m` of the column; the nearest places where there are none.
std::vector<VoxelKey> StandingNear(const policy::OneMapView& view, const Column& column,
                                   double reach_m) {
  std::vector<VoxelKey> near;
  double nearest_m = 1e9;
  for (const auto& [c, key] : view.standing) {
    const double d = policy::DistanceOf(c, column, view.voxel_m);
    if (d <= reach_m) near.push_back(key);
    nearest_m = std::min(nearest_m, d);
  }
  if (!near.empty()) return near;
  for (const auto& [c, key] : view.standing)
    if (policy::DistanceOf(c, column, view.voxel_m) <= nearest_m + view.voxel_m)
      near.push_back(key);
  return near;
}

std::optional<Target> PlanTo(const paper::Situation& now, Candidate candidate) {
  if (!now.start || candidate.standing.empty()) return std::nullopt;
  planner::GraphRules rules = paper::LevelRules(now);
  for (const bool allow_inflated : {false, true}) {
    rules.allow_inflated = allow_inflated;
    auto plan =
        planner::FindPath(now.world.map, *now.start, candidate.standing, rules, now.config.planner);
    if (plan.found()) return Target{std::move(candidate), std::move(plan), rules};
  }
  return std::nullopt;
}

double GroundDistance(const paper::Situation& now, const Vector3d& p_world) {
  return (p_world - now.agent.p_world).head<2>().norm();
}

/// The nearest point of the sighting that the map agrees with.
std::optional<OneMapObject> Believed(const paper::Situation& now, const policy::Sighting& sighting,
                                     const policy::OneMapView& view) {
  std::optional<OneMapObject> best;
  std::optional<Column> asked;
  bool is_believed = false;
  for (const VoxelKey& key : sighting.voxels) {
    const Column column{key.x, key.y};
    if (asked != column) is_believed = policy::HasConsensus(column, view);
    asked = column;
    const Vector3d p = CenterOf(key, view.voxel_m);
    if (!is_believed || now.goal.onemap.unreachable.contains(column)) continue;
    if (!best || GroundDistance(now, p) < GroundDistance(now, best->p_world)) best = {column, p};
  }
  return best;
}

double ScoreAt(const policy::OneMapView& view, const Column& column) {
  const auto it = view.similarity.find(column);
  return it == view.similarity.end() ? 0 : 1 + it->second;
}

/// Takes the frame's detections for the object, if the map agrees; forgets it where it does not.
void UpdateObject(paper::Situation& now, const std::vector<policy::Sighting>& sightings,
                  const policy::OneMapView& view) {
  auto& object = now.goal.onemap.object;
  const policy::ObjectConfig& config = now.config.policy.object;
  for (const policy::Sighting& sighting : sightings) {
    if (sighting.confidence < config.detector_confidence) continue;
    if (sighting.area_fraction < config.min_box_area_fraction) continue;
    const auto found = Believed(now, sighting, view);
    if (!found) continue;
    const double factor = now.config.policy.onemap.replace_factor;
    if (object && ScoreAt(view, found->column) < factor * ScoreAt(view, object->column)) continue;
    if (!object) now.goal.events.push_back("object detected");
    object = found;
  }
  if (object && !policy::HasConsensus(object->column, view)) {
    object.reset();
    now.goal.events.push_back("object forgotten: the map does not agree");
  }
}

/// Path to a place where the agent can stop at the object; without a path the object is forgotten.
std::optional<Target> PathToObject(paper::Situation& now, const policy::OneMapView& view) {
  auto& object = now.goal.onemap.object;
  if (!object) return std::nullopt;
  Candidate candidate;
  candidate.kind = CandidateKind::kLivePoi;
  candidate.p_focus_world = object->p_world;
  candidate.score = ScoreAt(view, object->column);
  candidate.standing =
      StandingNear(view, object->column, now.config.policy.approach.range_m - view.voxel_m);
  auto target = PlanTo(now, std::move(candidate));
  if (target) return target;
  now.goal.onemap.unreachable.insert(object->column);
  object.reset();
  now.goal.events.push_back("object without a path");
  return std::nullopt;
}

Candidate CandidateOf(const paper::Situation& now, const OneMapGoal& goal) {
  const double voxel_m = now.config.map.voxel_m;
  Candidate candidate;
  candidate.kind =
      goal.is_frontier ? CandidateKind::kTraversableFrontier : CandidateKind::kHistoryPoi;
  candidate.p_focus_world = CenterOf(VoxelKey{goal.center.x, goal.center.y, 0}, voxel_m);
  candidate.p_focus_world.z() = now.world.level_m;
  candidate.size = static_cast<int>(goal.columns.size());
  candidate.score = goal.score;
  return candidate;
}

/// The best goal that has a path; `shown` gets all of them.
std::optional<Target> ChooseGoal(paper::Situation& now, const policy::OneMapView& view,
                                 std::vector<Candidate>* shown) {
  auto& state = now.goal.onemap;
  auto goals = policy::OneMapGoals(view);
  std::erase_if(goals, [&](const OneMapGoal& goal) {
    return now.world.onemap.blacklist.contains(goal.center);
  });
  for (const OneMapGoal& goal : goals) shown->push_back(CandidateOf(now, goal));
  while (!goals.empty()) {
    const int chosen = policy::ChooseOneMapGoal(goals, state.last ? &*state.last : nullptr, view);
    const OneMapGoal goal = goals[static_cast<std::size_t>(chosen)];
    Candidate candidate = CandidateOf(now, goal);
    candidate.standing =
        StandingNear(view, goal.center, goal.is_frontier ? kFrontierReach_m : kPoiReach_m);
    if (auto target = PlanTo(now, std::move(candidate))) {
      if (!state.last || state.last->center != goal.center) state.stuck_steps = 0;
      state.last = goal;
      return target;
    }
    goals.erase(goals.begin() + chosen);
    state.last.reset();
  }
  return std::nullopt;
}

/// At its end: look there, and give it up when it does not go away.
Action LookAtGoal(paper::Situation& now, const Target& target) {
  auto& state = now.goal.onemap;
  if (++state.stuck_steps > now.config.policy.onemap.stuck_steps) {
    now.world.onemap.blacklist.insert(state.last->center);
    now.goal.events.push_back("goal does not go away");
    state.last.reset();
    state.stuck_steps = 0;
  }
  const auto look = policy::CenteringAction(now.eye, target.candidate.p_focus_world,
                                            now.config.sensor.camera_height_m, now.config.action);
  return look.value_or(Action::kTurnLeft);
}

std::optional<Action> Scripted(GoalState& goal) {
  if (goal.paper.script.empty()) return std::nullopt;
  const Action next = goal.paper.script.front();
  goal.paper.script.pop_front();
  return next;
}

void Start(paper::Situation& now) {
  World& world = now.world;
  if (world.has_level) return;
  world.has_level = true;
  world.level_m = now.agent.p_world.z();
  world.levels_m.push_back(world.level_m);
  paper::QueueLookAround(now.goal, now.agent, now.config.action);
}

/// Stop at the object, else on along the path, else look.
std::optional<Action> Act(paper::Situation& now, const std::optional<Target>& target) {
  const auto& object = now.goal.onemap.object;
  if (object && GroundDistance(now, object->p_world) <= now.config.policy.approach.range_m)
    return Action::kStop;
  if (auto action = Scripted(now.goal)) return action;
  if (!target) return std::nullopt;
  if (auto action = paper::FollowPath(now, *target)) return action;
  if (object) return Action::kTurnLeft;
  return LookAtGoal(now, *target);
}

policy::ModeDecision ModeOf(const std::optional<Target>& target) {
  if (!target) return {Mode::kBasicExplore, ModeReason::kExploring};
  switch (target->candidate.kind) {
    case CandidateKind::kLivePoi:
      return {Mode::kPoiNavigation, ModeReason::kLivePoi};
    case CandidateKind::kHistoryPoi:
      return {Mode::kPoiNavigation, ModeReason::kHistoryPoi};
    default:
      return {Mode::kBasicExplore, ModeReason::kExploring};
  }
}

}  // namespace

Decision Decide(StepState& given) {
  World& world = given.world;
  paper::Situation now{given.config,
                       world,
                       given.goal,
                       given.agent,
                       given.eye,
                       std::nullopt,
                       &world.paper.bumps.obstacles()};
  paper::NoticeBump(now);
  Start(now);
  now.start = planner::StartVoxel(world.map, given.agent.p_world);
  const double voxel_m = given.config.map.voxel_m;
  const auto standing = policy::StandingOn(
      world.map, policy::BandAround(world.level_m, given.config.policy.frontier, voxel_m));
  const auto similarity = policy::SimilarityOf(world.memory, given.goal.text);
  const policy::OneMapView view{world.onemap.map, standing, similarity, given.config.policy.onemap,
                                voxel_m};
  Decision decision;
  UpdateObject(now, given.sightings, view);
  std::optional<Target> target = PathToObject(now, view);
  if (!target && given.goal.paper.script.empty()) {
    target = ChooseGoal(now, view, &decision.shown);
    if (!target) {  // everything was checked: look at the places that answer best once more
      world.onemap.map.ClearChecked();
      target = ChooseGoal(now, view, &decision.shown);
    }
  }
  if (given.goal.onemap.object && target)
    decision.shown.insert(decision.shown.begin(), target->candidate);
  decision.mode = ModeOf(target);
  decision.action = Act(now, target);
  if (decision.action == Action::kStop)
    decision.p_claimed_world = given.goal.onemap.object->p_world;
  if (target) {
    decision.target = target->candidate;
    decision.path = target->plan.path;
    decision.path_cost = target->plan.cost;
  }
  world.paper.bumps.Commit(decision.action.value_or(Action::kTurnLeft), given.agent);
  return decision;
}

}  // namespace crossnav::agent::onemap
