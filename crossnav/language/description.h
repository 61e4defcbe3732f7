// SPDX-License-Identifier: MIT
// Description of a thing by a person: "the red armchair near the window upstairs". Plain data;
// parse_description.h parses it, resolve.h finds the thing. Readings of each word:
// docs/lifelong.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/language/colour_name.h"
#include "crossnav/language/room_type.h"

namespace crossnav::language {

enum class SizeWord { kBig, kSmall };  ///< largest, smallest of the things that fit otherwise

enum class Relation { kOn, kIn, kNextTo, kNear, kAbove, kUnder };
inline constexpr int kRelations = 6;

enum class FloorWord { kUpstairs, kDownstairs, kNumber, kTop, kBasement };

struct FloorPhrase {
  FloorWord word = FloorWord::kNumber;
  int number = 0;  ///< with kNumber: 0 = ground floor, 1 = the one above it
  friend bool operator==(const FloorPhrase&, const FloorPhrase&) = default;
};

struct RelationPhrase;

struct Description {
  std::string noun;          ///< canonical name (core/category_table.h): "sofa" for "couch"
  bool is_definite = false;  ///< "the": one particular thing; otherwise any thing
  int order = 0;             ///< 1 = the nearest to the robot, 2 ...; -1 = the farthest; 0 = none
  std::optional<SizeWord> size;
  std::optional<Colour> colour;
  std::vector<RelationPhrase> relations;
  std::optional<RoomType> room;
  std::optional<FloorPhrase> floor;

  /// A category alone, without any other part.
  bool IsPlain() const;
  friend bool operator==(const Description&, const Description&);
};

/// "near the window": any window.
struct RelationPhrase {
  Relation relation = Relation::kNear;
  Description landmark;  ///< without room and floor; they belong to the whole
  friend bool operator==(const RelationPhrase&, const RelationPhrase&);
};

std::string_view NameOf(Relation relation);
std::string TextOf(const FloorPhrase& floor);  ///< "on the first floor", "upstairs"
/// Words that parse to the same description.
std::string TextOf(const Description& description);

}  // namespace crossnav::language
