// SPDX-License-Identifier: MIT
// Names of colours, and how well a name fits the pixels of an object under a lamp.
#pragma once

#include <optional>
#include <string_view>

#include "crossnav/core/image.h"

namespace crossnav::language {

enum class Colour {
  kBlack,
  kGrey,
  kWhite,
  kBeige,
  kBrown,
  kRed,
  kOrange,
  kYellow,
  kGreen,
  kBlue,
  kPurple,
  kPink
};
inline constexpr int kColours = 12;

std::string_view NameOf(Colour colour);

enum class Fit { kNo, kMaybe, kYes };

/// Colour of a surface whose pixels are `seen` in a room under lamps, as people see past the shade.
Rgb8 SurfaceColourOf(const Rgb8& seen);

/// The name that people would give first.
Colour NameColour(const Rgb8& rgb);

/// kYes: the first name. kMaybe: a neighbour of it, as lamps and cameras turn one into the other.
Fit FitOf(Colour colour, const Rgb8& rgb);

}  // namespace crossnav::language
