// SPDX-License-Identifier: MIT
// Raw semantic names in HM3D's vocabulary for pieces of a home: by catalogue id (the same in every
// language), then by name. Unknown pieces keep their own name, in small letters.
#pragma once

#include <string>
#include <string_view>

#include "crossnav/homes/home_plan.h"

namespace crossnav::homes {

std::string RawNameOf(const HomePiece& piece);

/// `name` in the spelling of raw names: small letters, no brackets, no numbers at its end.
std::string Normalised(std::string_view name);

/// Raw name for a free name: unchanged if the category table or the word list has it, else by its
/// last words ("red wooden chair" is a chair), else `name` normalised.
std::string RawNameFor(std::string_view name);

}  // namespace crossnav::homes
