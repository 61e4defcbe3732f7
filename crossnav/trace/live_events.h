// SPDX-License-Identifier: MIT
// A replay as events, for a page that shows it while it happens (docs/formats/replay.md, "Live"):
// one head, then steps and stages. Each is one line of JSON with the same values as the page's
// file.
#pragma once

#include <string>
#include <vector>

#include "crossnav/geometry/voxel_map.h"
#include "crossnav/trace/replay.h"
#include "crossnav/trace/replay_writer.h"

namespace crossnav::trace {

/// `known`: the map before the first step, sorted by key.
std::string LiveHead(const ReplayInfo& info, const std::vector<geometry::StateChange>& known);

/// Costs as much as a step of ReplayWriter, a few milliseconds.
std::string LiveStep(const ReplayFrame& frame, const ReplayOptions& options = {});

std::string LiveStage(const StageResult& stage);

}  // namespace crossnav::trace
