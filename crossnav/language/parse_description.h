// SPDX-License-Identifier: MIT
// Words -> Description. The grammar, with [ ] for optional parts and * for repetition:
//
//   description = [the|a|any] [ordinal] (size|colour|room|floor)* thing place*
//   place       = [that is] (floor | on|in the floor | in the room | [and] relation description)
//
// Room and floor belong to the whole. A relation belongs to the thing before it; after "and", to
// the first thing.
#pragma once

#include <string_view>

#include "crossnav/core/result.h"
#include "crossnav/language/description.h"
#include "crossnav/language/word_stream.h"

namespace crossnav::language {

/// Parses the whole text. kInvalid names the unknown word, the nearest known word, and the words
/// expected there.
Result<Description> ParseDescription(std::string_view text);

/// Parses a description from the front of the stream to its end.
Result<Description> ParseDescription(WordStream& words);

/// Parses a room and floor without a noun: "in the kitchen", "upstairs", "on the first floor".
/// False if neither comes next.
bool ParsePlace(WordStream& words, Description* whole);

/// Parses all places to the end of the stream: relations, room, floor.
Result<void> ParsePlaces(WordStream& words, Description* whole);

/// Whether a goal is a description: it begins with an article. Any other text is a name, known or
/// not ("red box"), and goes to perception unchanged.
bool IsDescription(std::string_view text);

/// kInvalid: the next word is unknown; `wanted` is expected there.
Error NotUnderstood(const WordStream& words, std::string_view wanted);

}  // namespace crossnav::language
