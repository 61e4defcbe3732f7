// SPDX-License-Identifier: MIT
#include "crossnav/language/resolve.h"

#include <algorithm>
#include <cmath>

#include "crossnav/language/box_relation.h"
#include "crossnav/language/vocabulary.h"

namespace crossnav::language {
namespace {

constexpr double kStoreyDetour_m = 20;   // chosen: things on the robot's floor come first
constexpr double kClearlyLarger = 1.25;  // chosen: smaller ratios are not visible

Fit FloorFit(const FloorPhrase& phrase, const KnownHome& home, const Thing& thing) {
  if (!thing.floor) return Fit::kMaybe;
  const auto floors = FloorsOf(phrase, home);
  const bool fits = std::find(floors.begin(), floors.end(), *thing.floor) != floors.end();
  if (!home.may_have_more_floors || phrase.word == FloorWord::kUpstairs ||
      phrase.word == FloorWord::kDownstairs)
    return fits ? Fit::kYes : Fit::kNo;
  // An unknown floor below would raise every floor number by one.
  const bool could_fit = fits || (phrase.word == FloorWord::kNumber &&
                                  *thing.floor < home.ground_floor + phrase.number);
  return could_fit ? Fit::kMaybe : Fit::kNo;
}

bool IsSame(const Thing& a, const Thing& b) {
  return a.category == b.category && a.p_center_world == b.p_center_world;
}

Fit RelationFit(const RelationPhrase& phrase, const KnownHome& home, const Thing& thing) {
  const auto fit_to = [&](const Thing& other) {
    if (IsSame(thing, other) || (thing.room && other.room && thing.room != other.room))
      return Fit::kNo;
    if (phrase.relation == Relation::kOn && !CanStandOn(thing.category, other.category))
      return Fit::kNo;  // boxes of things that stand side by side can overlap
    return HoldsFor(phrase.relation, thing.box, other.box);
  };
  Fit best = Fit::kNo;
  if (phrase.landmark.order != 0 || phrase.landmark.size) {
    for (const int other : Resolve(phrase.landmark, home).things)
      best = std::max(best, fit_to(home.things[other]));
    return best;
  }
  for (const Thing& other : home.things) {
    if (!IsKindOf(other.category, phrase.landmark.noun)) continue;
    const Fit related = fit_to(other);
    if (related <= best) continue;
    best = std::max(best, std::min(related, FitOf(phrase.landmark, home, other)));
  }
  return best;
}

double DistanceTo(const KnownHome& home, const Thing& thing) {
  if (!home.p_robot_world) return 0;
  const double away_m = (thing.p_center_world - *home.p_robot_world).head<2>().norm();
  const auto own = FloorOf(home, *home.p_robot_world);
  const int storeys = own && thing.floor ? std::abs(*own - *thing.floor) : 0;
  return away_m + kStoreyDetour_m * storeys;
}

/// Area of the largest side of its box.
double SizeOf(const Thing& thing) {
  Vector3d sides = thing.box.max - thing.box.min;
  std::sort(sides.data(), sides.data() + 3);
  return sides[1] * sides[2];
}

/// Things of the extreme size, within kClearlyLarger.
std::vector<int> Extremes(const std::vector<int>& pool, SizeWord word, const KnownHome& home) {
  const auto size = [&](int i) { return SizeOf(home.things[i]); };
  const bool is_big = word == SizeWord::kBig;
  double extreme = size(pool.front());
  for (const int i : pool)
    extreme = is_big ? std::max(extreme, size(i)) : std::min(extreme, size(i));
  std::vector<int> kept;
  for (const int i : pool)
    if (is_big ? size(i) * kClearlyLarger > extreme : size(i) < extreme * kClearlyLarger)
      kept.push_back(i);
  return kept;
}

std::string Counted(std::size_t count, std::string_view noun) {
  return std::to_string(count) + " " + (count == 1 ? std::string(noun) : PluralOf(noun));
}

Resolution Nothing(const Description& description, const KnownHome& home) {
  Resolution none;
  if (description.floor && FloorsOf(*description.floor, home).empty()) {
    none.reason = "no such floor is known; the map has " + Counted(home.floors.size(), "floor");
    return none;
  }
  const auto unseen = UnseenRooms(description, home);
  none.outcome = unseen.empty() ? Outcome::kAbsent : Outcome::kUnknown;
  none.reason = unseen.empty() ? "every place where it could be was looked at"
                               : Counted(unseen.size(), "room") + " where it could be " +
                                     (unseen.size() == 1 ? "was" : "were") + " not looked at";
  return none;
}

Resolution Nth(int order, std::vector<int> pool, const KnownHome& home) {
  if (!home.p_robot_world)
    return {Outcome::kAmbiguous, std::move(pool), true,
            "which is first depends on where the robot stands"};
  const auto count = static_cast<int>(pool.size());
  if (order > count)
    return {Outcome::kAbsent, {}, true, "only " + std::to_string(count) + " of them are known"};
  return {Outcome::kFound, {order < 0 ? pool.back() : pool[order - 1]}, true, ""};
}

/// Adds things that miss only a relation, by little, because boxes of seen things are coarse.
void AddNearMisses(const Description& description, const KnownHome& home, std::vector<int>& pool) {
  Description unrelated = description;
  unrelated.relations.clear();
  for (const int i : AllThatFit(description, home, Fit::kMaybe))
    if (std::find(pool.begin(), pool.end(), i) == pool.end() &&
        FitOf(unrelated, home, home.things[i]) == Fit::kYes)
      pool.push_back(i);
}

}  // namespace

std::string_view NameOf(Outcome outcome) {
  constexpr std::string_view kNames[] = {"found", "ambiguous", "absent", "unknown"};
  return kNames[static_cast<int>(outcome)];
}

std::vector<int> FloorsOf(const FloorPhrase& phrase, const KnownHome& home) {
  const auto count = static_cast<int>(home.floors.size());
  std::vector<int> floors;
  int own = -1;  // no robot, or on no floor
  if (home.p_robot_world) own = FloorOf(home, *home.p_robot_world).value_or(-1);
  for (int i = 0; i < count; ++i) {
    // Without a floor above the robot, "upstairs" means the floors above the ground floor.
    const int up_from = own >= 0 && own + 1 < count ? own : home.ground_floor;
    const int down_from = own > 0 ? own : count - 1;
    const bool fits = (phrase.word == FloorWord::kUpstairs && i > up_from) ||
                      (phrase.word == FloorWord::kDownstairs && i < down_from) ||
                      (phrase.word == FloorWord::kTop && i + 1 == count) ||
                      (phrase.word == FloorWord::kBasement && i < home.ground_floor) ||
                      (phrase.word == FloorWord::kNumber && i == home.ground_floor + phrase.number);
    if (fits) floors.push_back(i);
  }
  return floors;
}

Fit FitOf(const Description& d, const KnownHome& home, const Thing& thing) {
  Fit fit = d.noun.empty() || IsKindOf(thing.category, d.noun) ? Fit::kYes : Fit::kNo;
  const auto also = [&fit](Fit other) { fit = std::min(fit, other); };
  if (d.floor && fit != Fit::kNo) also(FloorFit(*d.floor, home, thing));
  if (d.room && fit != Fit::kNo)
    also(thing.room ? home.rooms[*thing.room].fits[static_cast<int>(*d.room)] : Fit::kMaybe);
  if (d.colour && fit != Fit::kNo)
    also(thing.colour ? FitOf(*d.colour, *thing.colour) : Fit::kMaybe);
  for (const RelationPhrase& phrase : d.relations)
    if (fit != Fit::kNo) also(RelationFit(phrase, home, thing));
  return fit;
}

std::vector<int> AllThatFit(const Description& description, const KnownHome& home, Fit least) {
  std::vector<int> fitting;
  for (std::size_t i = 0; i < home.things.size(); ++i)
    if (FitOf(description, home, home.things[i]) >= least) fitting.push_back(static_cast<int>(i));
  std::stable_sort(fitting.begin(), fitting.end(), [&](int a, int b) {
    return DistanceTo(home, home.things[a]) < DistanceTo(home, home.things[b]);
  });
  return fitting;
}

std::vector<int> UnseenRooms(const Description& description, const KnownHome& home) {
  std::vector<int> unseen;
  const auto floors = description.floor ? FloorsOf(*description.floor, home) : std::vector<int>();
  for (std::size_t i = 0; i < home.rooms.size(); ++i) {
    const KnownRoom& room = home.rooms[i];
    if (room.WasLookedAt()) continue;
    if (description.floor && std::find(floors.begin(), floors.end(), room.floor) == floors.end())
      continue;
    if (description.room && room.fits[static_cast<int>(*description.room)] == Fit::kNo) continue;
    unseen.push_back(static_cast<int>(i));
  }
  return unseen;
}

Resolution Resolve(const Description& description, const KnownHome& home) {
  std::vector<int> pool = AllThatFit(description, home, Fit::kYes);
  const bool is_sure = !pool.empty();
  if (is_sure && description.is_definite && description.order == 0 && !description.size &&
      !description.relations.empty())
    AddNearMisses(description, home, pool);
  if (!is_sure) pool = AllThatFit(description, home, Fit::kMaybe);
  if (pool.empty()) return Nothing(description, home);
  if (description.size) pool = Extremes(pool, *description.size, home);
  Resolution found{Outcome::kFound, pool, true, ""};
  if (description.order != 0) {
    found = Nth(description.order, pool, home);
  } else if (description.is_definite && pool.size() > 1) {
    found = {Outcome::kAmbiguous, pool, true, Counted(pool.size(), description.noun) + " fit"};
  } else {
    found.things.resize(1);
  }
  found.is_sure = is_sure;
  return found;
}

}  // namespace crossnav::language
