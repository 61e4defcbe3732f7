// SPDX-License-Identifier: MIT
#include "crossnav/language/description.h"

#include "crossnav/language/vocabulary.h"

namespace crossnav::language {
namespace {

/// Text without relations, room and floor.
std::string HeadOf(const Description& d) {
  std::string text = d.is_definite ? "the " : "a ";
  if (d.order != 0) text += OrdinalOf(d.order) + " ";
  if (d.size) text += *d.size == SizeWord::kBig ? "big " : "small ";
  if (d.colour) text += std::string(NameOf(*d.colour)) + " ";
  text += d.noun;
  bool is_first = true;
  for (const RelationPhrase& phrase : d.relations) {
    text += is_first ? " " : " and ";
    text += std::string(NameOf(phrase.relation)) + " " + HeadOf(phrase.landmark);
    is_first = false;
  }
  return text;
}

}  // namespace

bool Description::IsPlain() const {
  return !is_definite && order == 0 && !size && !colour && relations.empty() && !room && !floor;
}

bool operator==(const Description& a, const Description& b) {
  return a.noun == b.noun && a.is_definite == b.is_definite && a.order == b.order &&
         a.size == b.size && a.colour == b.colour && a.relations == b.relations &&
         a.room == b.room && a.floor == b.floor;
}

bool operator==(const RelationPhrase& a, const RelationPhrase& b) {
  return a.relation == b.relation && a.landmark == b.landmark;
}

std::string_view NameOf(Relation relation) {
  constexpr std::string_view kNames[kRelations] = {"on", "in", "next to", "near", "above", "under"};
  return kNames[static_cast<int>(relation)];
}

std::string TextOf(const FloorPhrase& floor) {
  switch (floor.word) {
    case FloorWord::kUpstairs:
      return "upstairs";
    case FloorWord::kDownstairs:
      return "downstairs";
    case FloorWord::kTop:
      return "on the top floor";
    case FloorWord::kBasement:
      return "in the basement";
    case FloorWord::kNumber:
      break;
  }
  return floor.number == 0 ? "on the ground floor" : "on the " + OrdinalOf(floor.number) + " floor";
}

std::string TextOf(const Description& d) {
  std::string text = HeadOf(d);
  if (d.room) text += " in the " + std::string(NameOf(*d.room));
  if (d.floor) text += " " + TextOf(*d.floor);
  return text;
}

}  // namespace crossnav::language
