// SPDX-License-Identifier: MIT
// What is known of houses before one is entered: on which storey a thing is likelier to stand. It
// is how houses of several storeys are commonly built, and was not fitted to any; the agent needs
// it only to decide whether to finish a storey or to take a flight first.
#pragma once

#include <string_view>

namespace crossnav::policy {

/// log2 of how many times likelier a thing of this name is found on an upper storey than on the
/// lowest. Bedrooms lie above, living rooms below; 0 for what may be anywhere, or is not known.
double UpperStoreyBits(std::string_view goal);

}  // namespace crossnav::policy
