// SPDX-License-Identifier: MIT
// Colour names, and the fit of a name to an object's pixels under a lamp.
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

/// Surface colour of pixels `seen` under indoor lamps: corrects for shade.
Rgb8 SurfaceColourOf(const Rgb8& seen);

/// The nearest name.
Colour NameColour(const Rgb8& rgb);

/// kYes: the nearest name. kMaybe: a neighbouring name, because lamps and cameras confuse
/// neighbours.
Fit FitOf(Colour colour, const Rgb8& rgb);

}  // namespace crossnav::language
