// SPDX-License-Identifier: MIT
// Descriptions at random, for the properties of the parser.
#pragma once

#include <iterator>

#include "crossnav/core/rng.h"
#include "crossnav/language/vocabulary.h"

namespace crossnav::language {

template <class T>
T AnyOf(const WordTable<T>& table, Rng& rng) {
  return std::next(table.begin(), static_cast<std::ptrdiff_t>(rng.Below(table.size())))->second;
}

/// A head, and up to two landmarks one inside the other.
inline Description RandomHead(Rng& rng, int depth) {
  Description d;
  d.noun = AnyOf(ThingWords(), rng);
  d.is_definite = rng.Chance(0.6);
  if (rng.Chance(0.2)) d.order = AnyOf(OrdinalWords(), rng), d.is_definite = true;
  if (rng.Chance(0.2)) d.size = AnyOf(SizeWords(), rng);
  if (rng.Chance(0.3)) d.colour = AnyOf(ColourWords(), rng);
  if (depth > 0 && rng.Chance(0.5))
    d.relations.push_back({AnyOf(RelationWords(), rng), RandomHead(rng, depth - 1)});
  return d;
}

/// "in the toilet" is said of the room.
inline bool IsInToilet(const Description& d) {
  for (const RelationPhrase& phrase : d.relations)
    if ((phrase.relation == Relation::kIn && phrase.landmark.noun == "toilet") ||
        IsInToilet(phrase.landmark))
      return true;
  return false;
}

inline Description RandomDescription(Rng& rng) {
  Description d = RandomHead(rng, 2);
  while (rng.Chance(0.3)) d.relations.push_back({AnyOf(RelationWords(), rng), RandomHead(rng, 1)});
  if (rng.Chance(0.4)) d.room = AnyOf(RoomWords(), rng);
  if (rng.Chance(0.4)) d.floor = AnyOf(FloorWords(), rng);
  return d;
}

}  // namespace crossnav::language
