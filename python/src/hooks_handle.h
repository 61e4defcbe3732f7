// SPDX-License-Identifier: MIT
// Hooks in Python.
#pragma once

#include "common.h"
#include "crossnav/agent/hooks.h"

namespace crossnav::python {

/// The hooks behind `hooks`, which must be a crossnav.Hooks and outlive them; null for None. Raises
/// unless the profile uses hooks.
agent::Hooks* HooksOf(const nb::object& hooks, const agent::Config& config);

}  // namespace crossnav::python
