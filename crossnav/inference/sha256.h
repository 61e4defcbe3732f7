// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace crossnav::inference {

/// SHA-256 (FIPS 180-4) of `bytes`, 64 hexadecimal digits.
std::string Sha256(std::string_view bytes);

}  // namespace crossnav::inference
