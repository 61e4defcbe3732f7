// SPDX-License-Identifier: MIT
// The six HM3D ObjectNav categories (paper, "HM3D-MFMON Benchmark"), in a fixed order.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace crossnav {

inline constexpr std::array<std::string_view, 6> kCategories = {"chair",  "bed",        "plant",
                                                                "toilet", "tv_monitor", "sofa"};

inline bool IsCategory(std::string_view name) {
  return std::find(kCategories.begin(), kCategories.end(), name) != kCategories.end();
}

}  // namespace crossnav
