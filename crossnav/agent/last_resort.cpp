// SPDX-License-Identifier: MIT
#include "crossnav/agent/last_resort.h"

#include <array>

#include "crossnav/agent/cut_off.h"
#include "crossnav/agent/hints.h"
#include "crossnav/agent/object_search.h"
#include "crossnav/agent/pursuit.h"
#include "crossnav/agent/remembered_places.h"
#include "crossnav/agent/scan.h"
#include "crossnav/agent/settle.h"
#include "crossnav/agent/wanted_instance.h"

namespace crossnav::agent {
namespace {

constexpr double kStranded_m2 = 1.0;  // chosen: less ground than that of a landing

bool LookAroundAgain(StepState& now) {
  if ((now.goal.p_looked_around_world - now.agent.p_world).norm() < 0.5) return false;
  LookAround(now);
  now.goal.events.push_back("nothing left: looking around");
  return true;
}

bool ForgetBumps(StepState& now) {
  if (!now.world.ground.HasBlocked()) return false;
  now.world.ground.ForgetBlocked();
  now.goal.events.push_back("nothing left: bumps forgotten");
  return true;
}

/// Targets given up for lack of a path become candidates again.
void ForgiveUnreachable(GoalState* goal) {
  std::erase_if(goal->full.attempts, [](const Attempt& attempt) {
    return attempt.ending == Ending::kUnreachable || attempt.ending == Ending::kNoProgress;
  });
}

/// The upper part of a door that stood elsewhere on an earlier day bars the way in the map.
bool LookUpAtBars(StepState& now) {
  if (now.world.map.config().clearing != "evidence") return false;
  const CutOff cut_off = FindCutOff(now);
  if (cut_off.IsEmpty() || !LookUp(now)) return false;
  ForgiveUnreachable(&now.goal);
  now.goal.events.push_back("cut off: " + Describe(cut_off) + "; looking up");
  return true;
}

bool Squeeze(StepState& now) {
  const CutOff cut_off = FindCutOff(now);
  if (cut_off.IsEmpty()) return false;
  now.goal.full.may_squeeze = true;
  ForgiveUnreachable(&now.goal);
  now.goal.events.push_back("cut off: " + Describe(cut_off) + "; narrow gaps are tried");
  return true;
}

bool StepOnSeats(StepState& now) {
  const CutOff cut_off = FindCutOff(now);
  if (cut_off.IsEmpty()) return false;
  now.goal.full.may_step_on_seats = true;
  ForgiveUnreachable(&now.goal);
  now.goal.events.push_back("cut off: " + Describe(cut_off) + "; rises like seats are tried");
  return true;
}

/// On a steep flight the foot may be between two treads of the map, so that no path begins there.
bool StepOut(StepState& now) {
  const CutOff cut_off = FindCutOff(now);
  if (cut_off.IsEmpty() || cut_off.reached_m2 >= kStranded_m2) return false;
  BeginEscape(now);
  now.goal.events.push_back("stranded: a step is tried in every heading");
  return true;
}

bool AskMemoryAgain(StepState& now) {
  Config relaxed = now.config;
  relaxed.query.min_similarity *= 0.8;  // chosen: looser, still a response
  relaxed.query.min_z_score *= 0.6;
  now.goal.history = RememberedPlaces(now.world, now.goal, relaxed);
  if (now.goal.history.empty()) return false;
  now.goal.events.push_back("nothing left: asking the memory again");
  return true;
}

bool TryAllAgain(StepState& now) {
  GoalState& goal = now.goal;
  goal.full.attempts.clear();
  goal.full.looks.clear();
  goal.live.ForgiveDiscarded();
  goal.instances.set_aside.clear();
  goal.tried_viewpoints.clear();
  goal.failed_views = 0;
  goal.full.failed.clear();
  now.world.coverage.Clear();
  constexpr double kNearer = 0.6;  // chosen: near enough for the smallest category
  goal.full.inspect_range_m *= kNearer;
  SearchNearer(now, kNearer);
  now.world.ground.ForgetBlocked();
  goal.events.push_back("nothing left: trying once more with relaxed limits");
  return true;
}

/// A small thing was passed unnoticed: ground and tops of furniture are looked at from near.
bool SearchClosely(StepState& now) {
  if (!BeginCloseSearch(now)) return false;
  now.goal.events.push_back("nothing left: searching from near");
  return true;
}

/// memory.mode = revise: the search goes on without the places that cannot be seen any more.
bool LeaveOutUnreachable(StepState& now) {
  if (!LeaveOutHidden(now)) return false;
  now.goal.events.push_back("nothing left: places out of reach are left out");
  return true;
}

/// The goal may still be where no way leads.
bool SettleIfAllIsReached(StepState& now) {
  return FindCutOff(now).IsEmpty() && SettleForLikeliest(now);
}

// A step out may end on another tread that no path leaves: it is tried several times.
constexpr std::array kResorts = {
    TakeGuesses, SettleIfAllIsReached, LookAroundAgain,    ForgetBumps,   LookUpAtBars, Squeeze,
    StepOut,     LeaveOutUnreachable,  SettleForLikeliest, SearchClosely, StepOnSeats,  StepOut,
    StepOut,     AskMemoryAgain,       TryAllAgain,        StepOut};
constexpr std::size_t kOpening = 8;  // the first of them open ways, or leave out what has none

constexpr std::array kWays = {ForgetBumps, Squeeze};
constexpr int kReachIsChecked_steps = 6;  // chosen: as policy.explore.reconsider_steps

}  // namespace

bool HasOpeningResort(const GoalState& goal) {
  return goal.full.last_resorts < kOpening;
}

bool TryLastResort(StepState& now) {
  GoalState& goal = now.goal;
  // Before a room or a floor is given up, closed ways are tried.
  if (IsSearchOver(now) && !(HasOpeningResort(goal) && IsPartCutOff(now))) {
    if (SettleForSteadySight(now)) return true;
    goal.events.push_back("all explored; everywhere looked at, it is gone");
    return false;
  }
  while (goal.full.last_resorts < kResorts.size()) {
    if (!kResorts[goal.full.last_resorts++](now)) continue;
    for (HistoryPoi& poi : goal.history) poi.unreachable_step.reset();
    return true;
  }
  goal.events.push_back("all explored; cut off: " + Describe(FindCutOff(now)));
  return false;
}

void OpenWayToSteadySight(StepState& now) {
  GoalState& goal = now.goal;
  const Pursued* pursued = PursuedIn(PursuitOf(goal.full.activity));
  if (goal.full.ways_tried == kWays.size() || now.world.step % kReachIsChecked_steps != 0 ||
      !pursued || !IsExploring(PursuitOf(goal.full.activity)) ||
      pursued->target.kind == policy::CandidateKind::kSighting)
    return;
  const policy::LivePoi* sight = SteadySight(now);
  if (!sight || IsSeenFromReach(now, sight->id)) return;
  while (goal.full.ways_tried < kWays.size()) {
    if (!kWays[goal.full.ways_tried++](now)) continue;
    ForgiveUnreachable(&goal);
    goal.events.push_back("no way led to what many frames showed");
    End(now, Ending::kSuperseded);
    return;
  }
}

}  // namespace crossnav::agent
