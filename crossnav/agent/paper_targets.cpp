// SPDX-License-Identifier: MIT
#include "crossnav/agent/paper_targets.h"

#include <algorithm>
#include <cmath>

#include "crossnav/agent/observation_place.h"
#include "crossnav/agent/shared_parts.h"
#include "crossnav/policy/approach.h"
#include "crossnav/policy/frontiers.h"

namespace crossnav::agent::paper {

using geometry::VoxelKey;
using planner::FindPath;
using planner::GraphKind;
using planner::GraphRules;
using planner::Plan;
using policy::Candidate;
using policy::CandidateKind;

namespace {

constexpr double kLinkReach_m =
    1.6;  // chosen: an entrance this near a walked flight's end is that flight
constexpr double kSameFocus_m = 0.75;  // chosen: a frontier that shrank is still the same frontier

planner::LevelBand LevelOf(const Situation& now, double level_m) {
  return policy::BandAround(level_m, now.config.policy.frontier, now.config.map.voxel_m);
}

/// Drops members near blacklisted places, and candidates that lose all of them.
std::vector<Candidate> Without(std::vector<Candidate> candidates,
                               const std::vector<policy::BlacklistedPlace>& places,
                               double voxel_m) {
  if (places.empty()) return candidates;
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    Candidate rest = candidate;
    rest.standing.clear();
    rest.beyond.clear();
    for (std::size_t i = 0; i < candidate.standing.size(); ++i) {
      const bool has_beyond = i < candidate.beyond.size();
      const VoxelKey about = has_beyond ? candidate.beyond[i] : candidate.standing[i];
      if (IsBlacklisted(places, CenterOf(about, voxel_m))) continue;
      rest.standing.push_back(candidate.standing[i]);
      if (has_beyond) rest.beyond.push_back(candidate.beyond[i]);
    }
    if (!rest.standing.empty() && !IsBlacklisted(places, rest.p_focus_world))
      kept.push_back(std::move(rest));
  }
  return kept;
}

Target MakeTarget(Candidate candidate, Plan plan, const GraphRules& rules) {
  return Target{std::move(candidate), std::move(plan), rules};
}

std::optional<Target> PlanTo(const Situation& now, const Candidate& candidate, GraphRules rules,
                             bool may_inflate = false) {
  if (!now.start || candidate.standing.empty()) return std::nullopt;
  Plan plan = FindPath(now.world.map, *now.start, candidate.standing, rules, now.config.planner);
  if (!plan.found() && may_inflate) {
    rules.allow_inflated = true;
    plan = FindPath(now.world.map, *now.start, candidate.standing, rules, now.config.planner);
  }
  if (!plan.found()) return std::nullopt;
  return MakeTarget(candidate, std::move(plan), rules);
}

/// The candidate that continues the commitment, or -1.
int FindCommitted(const std::vector<Candidate>& candidates, const Commitment& commitment) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    if (c.kind != commitment.kind) continue;
    if ((c.p_focus_world - commitment.p_focus_world).norm() <= kSameFocus_m)
      return static_cast<int>(i);
    const bool shares = std::any_of(c.standing.begin(), c.standing.end(), [&](const VoxelKey& key) {
      return std::binary_search(commitment.standing.begin(), commitment.standing.end(), key);
    });
    if (shares) return static_cast<int>(i);
  }
  return -1;
}

bool IsNear(const Vector3d& p_end_world, const Candidate& candidate) {
  return (candidate.p_focus_world - p_end_world).norm() < kLinkReach_m;
}

bool IsWalkedEntrance(const World& world, const Candidate& candidate) {
  return std::any_of(world.flights.begin(), world.flights.end(), [&](const auto& flight) {
    return flight.IsWalked() &&
           (IsNear(flight.p_foot_world, candidate) || IsNear(flight.p_top_world, candidate));
  });
}

/// Whether anything is left to explore on the level at `level_m`.
bool LevelHasWork(const Situation& now, double level_m) {
  const auto frontiers =
      policy::TraversableFrontiers(now.world.map, LevelOf(now, level_m), now.config.policy.frontier,
                                   now.config.policy.frontier.min_cluster);
  if (!Without(frontiers, now.goal.paper.frontier_blacklist, now.config.map.voxel_m).empty())
    return true;
  return !OpenEntrances(now, level_m, false).empty();
}

/// Entrances of walked flights with unexplored candidates at the other end.
std::vector<Candidate> ReturnEntrances(const Situation& now) {
  std::vector<Candidate> back;
  for (Candidate& candidate : OpenEntrances(now, now.world.level_m, true)) {
    const auto& flights = now.world.flights;
    const bool leads_to_work =
        std::any_of(flights.begin(), flights.end(), [&](const geometry::StairFlight& flight) {
          const bool at_foot = IsNear(flight.p_foot_world, candidate);
          const bool at_top = IsNear(flight.p_top_world, candidate);
          const double other_m = at_foot ? flight.p_top_world.z() : flight.p_foot_world.z();
          return flight.IsWalked() && (at_foot || at_top) && LevelHasWork(now, other_m);
        });
    if (leads_to_work) back.push_back(std::move(candidate));
  }
  return back;
}

}  // namespace

GraphRules LevelRules(const Situation& now) {
  GraphRules rules;
  rules.start_reach_vox = kBlindRing_vox;
  rules.obstacles = now.obstacles;
  const auto band = LevelOf(now, now.world.level_m);
  const auto support = now.start ? planner::SupportZ(now.world.map, *now.start) : std::nullopt;
  if (support && band.Contains(*support)) rules.level = band;
  return rules;
}

GraphRules WholeMapRules(const Situation& now) {
  GraphRules rules;
  rules.start_reach_vox = kBlindRing_vox;
  rules.obstacles = now.obstacles;
  if (now.config.policy.planar) rules.level = LevelOf(now, now.world.level_m);
  return rules;
}

std::optional<Target> ChooseFrontier(Situation& now, const std::vector<Candidate>& candidates) {
  if (!now.start || candidates.empty()) return std::nullopt;
  const GraphRules rules = LevelRules(now);
  std::vector<VoxelKey> goals;
  std::vector<std::size_t> owner;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (const VoxelKey& key : candidates[i].standing) {
      goals.push_back(key);
      owner.push_back(i);
    }
  Plan plan = FindPath(now.world.map, *now.start, goals, rules, now.config.planner);
  if (!plan.found()) return std::nullopt;
  const Candidate& chosen = candidates[owner[plan.goal_index]];
  auto& commitment = now.goal.paper.commitment;
  // Chosen again after its grace period, a frontier that was looked at keeps its looks.
  const int looks =
      commitment && FindCommitted({chosen}, *commitment) == 0 ? commitment->arrived_looks : 0;
  commitment =
      Commitment{chosen.kind, chosen.p_focus_world, chosen.standing, now.world.step, looks};
  return MakeTarget(chosen, std::move(plan), rules);
}

std::vector<Candidate> OpenFrontiers(const Situation& now) {
  const auto& config = now.config.policy.frontier;
  const int min_cluster =
      now.world.step < 12 ? config.min_cluster_init_descent : config.min_cluster;
  return Without(policy::TraversableFrontiers(now.world.map, LevelOf(now, now.world.level_m),
                                              config, min_cluster),
                 now.goal.paper.frontier_blacklist, now.config.map.voxel_m);
}

std::vector<Candidate> OpenEntrances(const Situation& now, double level_m, bool include_walked) {
  if (now.config.policy.planar) return {};
  const auto band = LevelOf(now, level_m);
  const World& world = now.world;
  auto down = policy::DescendFrontiers(world.map, band, now.config.policy.frontier);
  auto up = policy::AscentFrontiers(policy::FlightsFrom(world.stairs, world.map, level_m, +1),
                                    world.map, band, now.config.policy.stair);
  // Descend before ascent, unless the last transition led up.
  auto& first = world.paper.last_direction > 0 ? up : down;
  auto& second = world.paper.last_direction > 0 ? down : up;
  first.insert(first.end(), second.begin(), second.end());
  auto open = Without(std::move(first), now.goal.paper.set_aside, now.config.map.voxel_m);
  if (!include_walked)
    std::erase_if(open, [&](const Candidate& c) { return IsWalkedEntrance(world, c); });
  return open;
}

namespace {

/// The committed candidate, of any class, until its grace period is over (sec. "Candidate
/// Priority"): no other frontier replaces it while it is there and can be reached.
std::optional<Target> KeepCommitted(Situation& now, const std::vector<Candidate>& frontiers) {
  auto& commitment = now.goal.paper.commitment;
  if (!commitment) return std::nullopt;
  if (now.world.step - commitment->since_step >= now.config.policy.frontier.grace_steps)
    return std::nullopt;
  const bool is_entrance = commitment->kind != CandidateKind::kTraversableFrontier;
  const auto candidates = is_entrance ? OpenEntrances(now, now.world.level_m, true) : frontiers;
  const int kept = FindCommitted(candidates, *commitment);
  if (kept < 0) return std::nullopt;
  auto target = PlanTo(now, candidates[static_cast<std::size_t>(kept)], LevelRules(now));
  if (target) commitment->standing = target->candidate.standing;
  return target;
}

}  // namespace

std::optional<Target> ChooseExploration(Situation& now, std::vector<Candidate>* shown) {
  *shown = OpenFrontiers(now);
  if (auto target = KeepCommitted(now, *shown)) {
    if (target->candidate.kind != CandidateKind::kTraversableFrontier)
      shown->push_back(target->candidate);
    return target;
  }
  if (auto target = ChooseFrontier(now, *shown)) return target;
  const auto try_classes = [&](const std::vector<Candidate>& entrances) -> std::optional<Target> {
    shown->insert(shown->end(), entrances.begin(), entrances.end());
    // One class after the other, in the order in which OpenEntrances lists them.
    for (std::size_t i = 0; i < entrances.size();) {
      std::size_t end = i;
      while (end < entrances.size() && entrances[end].kind == entrances[i].kind) ++end;
      const std::vector<Candidate> one_class(entrances.begin() + static_cast<std::ptrdiff_t>(i),
                                             entrances.begin() + static_cast<std::ptrdiff_t>(end));
      if (auto target = ChooseFrontier(now, one_class)) return target;
      i = end;
    }
    return std::nullopt;
  };
  if (auto target = try_classes(OpenEntrances(now, now.world.level_m, false))) return target;
  if (auto target = try_classes(ReturnEntrances(now))) return target;
  now.goal.paper.commitment.reset();
  return std::nullopt;
}

std::optional<Target> ChooseLivePoi(const Situation& now, int* id) {
  const double camera_m = now.config.sensor.camera_height_m;
  const auto& approach = now.config.policy.approach;
  for (const policy::LivePoi* poi : now.goal.live.Stable(now.config.policy.object)) {
    if (IsBlacklisted(now.goal.paper.blacklist, poi->p_center_world)) continue;
    Candidate candidate = CandidateOf(*poi);
    const bool is_active = poi->id == now.goal.active_live;
    candidate.standing =
        policy::Viewpoints(now.world.map, poi->voxels, approach.range_m - 0.1, approach, camera_m,
                           is_active ? now.goal.tried_viewpoints : std::vector<Vector3d>{});
    if (auto target = PlanTo(now, candidate, WholeMapRules(now), true)) {
      *id = poi->id;
      return target;
    }
  }
  return std::nullopt;
}

std::optional<Target> ChooseHistoryPoi(Situation& now, int* index) {
  const auto try_poi = [&](int i) -> std::optional<Target> {
    HistoryPoi& poi = now.goal.history[static_cast<std::size_t>(i)];
    if (poi.is_exhausted || IsBlacklisted(now.goal.paper.blacklist, poi.p_center_world))
      return std::nullopt;
    Candidate candidate = CandidateOf(poi);
    if (!now.start) return std::nullopt;
    auto view = PathToView(now.world.map, *now.start, poi.voxels, WholeMapRules(now), now.config);
    if (!view) return std::nullopt;
    candidate.standing = std::move(view->standing);
    *index = i;
    return MakeTarget(std::move(candidate), std::move(view->plan), view->rules);
  };
  if (now.goal.paper.active_history >= 0) {
    if (auto target = try_poi(now.goal.paper.active_history)) return target;
  }
  for (int i = 0; i < static_cast<int>(now.goal.history.size()); ++i) {
    if (i == now.goal.paper.active_history) continue;
    if (auto target = try_poi(i)) return target;
  }
  return std::nullopt;
}

std::optional<Target> ChooseStairFrontier(const Situation& now) {
  if (!now.start) return std::nullopt;
  const auto frontiers = StairFrontiers(*now.goal.paper.session, now.world.map, now.agent.p_world);
  const double here_m = now.goal.paper.session->direction *
                        (now.agent.p_world.z() - now.goal.paper.session->entrance_level_m);
  // First by individually seen steps; the sphere bridges treads hidden behind their risers.
  for (const GraphKind kind : {GraphKind::kNormal, GraphKind::kStair}) {
    planner::PlannerConfig local = now.config.planner;
    // chosen: a flight and its landings; an expansion of the sphere looks at 4,188 neighbours.
    local.max_expansions = kind == GraphKind::kNormal ? 8000 : 400;
    for (const Candidate& candidate : frontiers) {
      const bool is_behind = candidate.score < here_m + 0.1;
      if (is_behind && kind == GraphKind::kNormal) break;
      GraphRules rules;
      rules.kind = kind;
      rules.obstacles = now.obstacles;
      for (const bool allow_inflated : {false, true}) {
        rules.allow_inflated = allow_inflated;
        Plan plan = FindPath(now.world.map, *now.start, candidate.standing, rules, local);
        if (plan.found()) return MakeTarget(candidate, std::move(plan), rules);
      }
    }
  }
  return std::nullopt;
}

}  // namespace crossnav::agent::paper
