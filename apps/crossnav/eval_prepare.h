// SPDX-License-Identifier: MIT
// Checks of `eval` before the first step.
#pragma once

#include <vector>

#include "crossnav/evaluation/running/evaluation.h"
#include "session.h"

namespace crossnav::app {

/// Checks every episode in its scene, certifies episodes without a certificate, and records the
/// scenes' hashes in the header. Only worker processes load scenes: a process with the ray caster's
/// threads must not be forked.
Result<void> PrepareEval(SceneCache& cache, int jobs, std::vector<evaluation::Episode>& episodes,
                         evaluation::RunHeader& header, Console& console);

}  // namespace crossnav::app
