// SPDX-License-Identifier: MIT
// Raw semantic names, as HM3D has them, for pieces of a home: by catalogue id (the same in every
// language), then by name. What nobody knows keeps its own name, in small letters.
#pragma once

#include <string>
#include <string_view>

#include "crossnav/homes/home_plan.h"

namespace crossnav::homes {

std::string RawNameOf(const HomePiece& piece);

/// `name` in the spelling of raw names: small letters, no brackets, no numbers at its end.
std::string Normalised(std::string_view name);

/// A raw name for a free one: itself where the category table or the word list has it, else by its
/// last words ("red wooden chair" is a chair), else `name` normalised.
std::string RawNameFor(std::string_view name);

}  // namespace crossnav::homes
