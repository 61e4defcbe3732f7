// SPDX-License-Identifier: MIT
// What `eval` proves before the first step.
#pragma once

#include <vector>

#include "crossnav/evaluation/running/evaluation.h"
#include "session.h"

namespace crossnav::app {

/// Checks every episode in its scene, certifies those that come without a certificate, and notes
/// the scenes' hashes in the header. Scenes are loaded by worker processes alone: a process with
/// the ray caster's threads must not be forked.
Result<void> PrepareEval(SceneCache& cache, int jobs, std::vector<evaluation::Episode>& episodes,
                         evaluation::RunHeader& header, Console& console);

}  // namespace crossnav::app
