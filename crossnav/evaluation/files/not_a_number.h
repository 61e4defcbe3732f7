// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace crossnav::evaluation {

/// JSON has no NaN, but Python writes it: names the key with a NaN. Empty if there is none.
std::string DescribeNotANumber(const std::string& text);

}  // namespace crossnav::evaluation
