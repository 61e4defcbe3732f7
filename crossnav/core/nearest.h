// SPDX-License-Identifier: MIT
// Suggestions for mistyped names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace crossnav {

/// `; did you mean "name"?` with the nearest of `names`, the first of equals; empty where none is
/// near.
std::string DidYouMean(std::string_view word, std::span<const std::string> names);

}  // namespace crossnav
