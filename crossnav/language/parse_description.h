// SPDX-License-Identifier: MIT
// Words -> Description. The grammar, with [ ] for what may be left out and * for repetition:
//
//   description = [the|a|any] [ordinal] (size|colour|room|floor)* thing place*
//   place       = [that is] (floor | on|in the floor | in the room | [and] relation description)
//
// Room and floor are said of the whole. A relation belongs to the thing before it; after "and" it
// belongs to the first.
#pragma once

#include <string_view>

#include "crossnav/core/result.h"
#include "crossnav/language/description.h"
#include "crossnav/language/word_stream.h"

namespace crossnav::language {

/// The whole text. kInvalid names the word that is not understood, the nearest that is, and what
/// could stand there.
Result<Description> ParseDescription(std::string_view text);

/// A description at the front of the stream, up to its end.
Result<Description> ParseDescription(WordStream& words);

/// Room and floor alone: "in the kitchen", "upstairs", "on the first floor"; noun empty.
/// False where nothing of that kind comes next.
bool ParsePlace(WordStream& words, Description* whole);

/// All places up to the end of the stream: relations, room, floor.
Result<void> ParsePlaces(WordStream& words, Description* whole);

/// Whether a goal is to be read as a description: it begins with an article. Any other text is a
/// name, known or not ("red box"), which perception is asked for as it stands.
bool IsDescription(std::string_view text);

/// kInvalid: the next word is not understood, `wanted` could stand there.
Error NotUnderstood(const WordStream& words, std::string_view wanted);

}  // namespace crossnav::language
