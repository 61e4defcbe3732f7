// SPDX-License-Identifier: MIT
// Vocabulary of descriptions and questions, each phrase with its meaning. Phrases are lower-case
// words separated by one space.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "crossnav/language/description.h"

namespace crossnav::language {

template <class T>
using WordTable = std::map<std::string, T, std::less<>>;

const WordTable<Colour>& ColourWords();
const WordTable<SizeWord>& SizeWords();
const WordTable<int>& OrdinalWords();  ///< 1, 2, ...; -1 = last
const WordTable<Relation>& RelationWords();
const WordTable<RoomType>& RoomWords();
const WordTable<FloorPhrase>& FloorWords();  ///< "upstairs", "first floor"
/// Nouns, singular and plural -> canonical: the table of names (core/category_table.h), and
/// household objects outside the goal categories.
const WordTable<std::string>& ThingWords();

/// "second" for 2, "last" for -1.
std::string OrdinalOf(int order);

/// "chairs" for "chair".
std::string PluralOf(std::string_view noun);

/// Whether `noun` names `category`: the same name, or its last words ("floor lamp" is a lamp). Goal
/// categories match their own name only.
bool IsKindOf(std::string_view category, std::string_view noun);

/// Whether a thing of `category` can stand on that furniture: beds stand on the ground or a rug,
/// windows are in walls.
bool CanStandOn(std::string_view category, std::string_view furniture);

/// Canonical names of kinds of `noun` (IsKindOf), `noun` first.
std::vector<std::string> KindsOf(std::string_view noun);

}  // namespace crossnav::language
