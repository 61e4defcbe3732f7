// SPDX-License-Identifier: MIT
// The words that descriptions and questions are made of, each with what it stands for. Phrases are
// words with one space between them, in small letters.
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
/// Names of things, singular and plural -> canonical: the table of names (core/category_table.h)
/// and household things that are no goal category.
const WordTable<std::string>& ThingWords();

/// "second" for 2, "last" for -1.
std::string OrdinalOf(int order);

/// "chairs" for "chair".
std::string PluralOf(std::string_view noun);

/// Whether a thing of `category` is called `noun`: itself, or what it ends with ("floor lamp" is a
/// lamp). Names of the goal categories stand for themselves alone.
bool IsKindOf(std::string_view category, std::string_view noun);

/// Whether such a thing can stand on that furniture: beds stand on the ground or a rug, windows are
/// in walls.
bool CanStandOn(std::string_view category, std::string_view furniture);

/// Canonical names that IsKindOf `noun`, itself first.
std::vector<std::string> KindsOf(std::string_view noun);

}  // namespace crossnav::language
