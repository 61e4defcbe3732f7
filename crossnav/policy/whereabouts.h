// SPDX-License-Identifier: MIT
// Floor prior: the storey on which an object is likelier to stand. It states how houses of several
// storeys are commonly built, and was not fitted to any; the agent uses it to decide whether to
// finish a storey or to take a flight first.
#pragma once

#include <string_view>

namespace crossnav::policy {

/// log2 of how many times likelier a thing of this name is found on an upper storey than on the
/// lowest. Bedrooms lie above, living rooms below; 0 for objects of any storey, or unknown names.
double UpperStoreyBits(std::string_view goal);

}  // namespace crossnav::policy
