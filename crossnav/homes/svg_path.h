// SPDX-License-Identifier: MIT
// Outlines of floor cut-outs as SVG paths (M L H V C Q A Z, absolute and relative).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "crossnav/homes/polygon.h"

namespace crossnav::homes {

/// Closed outlines with curves as short lines, in the file's coordinates (y is not flipped);
/// nullopt if the text is no such path.
std::optional<std::vector<Polygon>> ParseSvgPath(std::string_view text);

}  // namespace crossnav::homes
