// SPDX-License-Identifier: MIT
#include "crossnav/agent/wanted_instance.h"

#include <algorithm>
#include <utility>

namespace crossnav::agent {

using language::Fit;

namespace {

bool MeansOneInstance(const GoalState& goal) {
  return goal.described || goal.pictured;
}

Fit FitOfPoi(const World& world, const GoalState& goal, const policy::LivePoi& poi) {
  return goal.described ? FitOfDescription(world, goal, poi.voxels, poi.p_center_world)
                        : FitOfPicture(goal, goal.pictured->judged.at(poi.id).log_odds);
}

/// Places that may be it, the likeliest first.
std::vector<HistoryPoi> PlacesAlike(const std::vector<HistoryPoi>& places, const World& world,
                                    const GoalState& goal) {
  std::vector<std::pair<double, HistoryPoi>> alike;
  for (const HistoryPoi& place : places) {
    const double odds = LogOdds(LikenessAt(world, goal, place.voxels, place.p_center_world),
                                goal.pictured->encoder_name);
    if (FitOfPicture(goal, odds) != Fit::kNo) alike.emplace_back(odds, place);
  }
  std::stable_sort(alike.begin(), alike.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<HistoryPoi> out;
  for (auto& [odds, place] : alike) out.push_back(std::move(place));
  return out;
}

/// Words of events.
struct Words {
  const char *fits_now, *is_other, *is_perhaps, *guesses;
};

Words WordsFor(const GoalState& goal) {
  if (goal.described)
    return {"an object set aside fits the description now", "not the one that was described",
            "perhaps the one that was described: later",
            "nothing left: what may fit the description will do"};
  return {"an object set aside is the one in the picture", "not the one in the picture",
          "perhaps the one in the picture: later",
          "nothing left: the object most like the picture will do"};
}

}  // namespace

std::vector<HistoryPoi> FittingPlaces(std::vector<HistoryPoi> places, const World& world,
                                      const GoalState& goal) {
  if (goal.pictured) return PlacesAlike(places, world, goal);
  if (!goal.described) return places;
  const auto fit_of = [&](const HistoryPoi& place) {
    return FitOfDescription(world, goal, place.voxels, place.p_center_world);
  };
  std::erase_if(places, [&](const HistoryPoi& place) { return fit_of(place) == Fit::kNo; });
  std::stable_sort(places.begin(), places.end(),
                   [&](const HistoryPoi& a, const HistoryPoi& b) { return fit_of(a) > fit_of(b); });
  return places;
}

void JudgeInstances(StepState& now) {
  GoalState& goal = now.goal;
  if (!MeansOneInstance(goal)) return;
  KeepHomeFresh(now.world, now.config, now.agent, &goal);
  KeepLikenessFresh(now.world, &goal);
  InstanceChoice& choice = goal.instances;
  const Words words = WordsFor(goal);
  for (const policy::LivePoi& poi : std::vector<policy::LivePoi>(goal.live.all())) {
    const Fit fit = FitOfPoi(now.world, goal, poi);
    const bool fits = fit == Fit::kYes || (fit == Fit::kMaybe && choice.takes_guesses);
    if (fits && choice.set_aside.erase(poi.id) > 0) {
      goal.live.Forgive(poi.id);
      goal.events.push_back(words.fits_now);
    } else if (!fits && !poi.is_discarded && choice.set_aside.insert(poi.id).second) {
      goal.live.Discard(poi.id);
      goal.events.push_back(fit == Fit::kNo ? words.is_other : words.is_perhaps);
    }
  }
}

bool TakeGuesses(StepState& now) {
  GoalState& goal = now.goal;
  if (!MeansOneInstance(goal) || goal.instances.takes_guesses) return false;
  goal.instances.takes_guesses = true;
  LookAtHome(now.world, now.config, &goal);
  goal.events.push_back(WordsFor(goal).guesses);
  return true;
}

}  // namespace crossnav::agent
