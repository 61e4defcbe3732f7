// SPDX-License-Identifier: MIT
// Outlines of floor cut-outs, written as SVG paths (M L H V C Q A Z, absolute and relative).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "crossnav/homes/polygon.h"

namespace crossnav::homes {

/// Closed outlines with curves as short lines, as written (y is not turned); nullopt where the text
/// is not such a path.
std::optional<std::vector<Polygon>> ParseSvgPath(std::string_view text);

}  // namespace crossnav::homes
