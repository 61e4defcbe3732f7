// SPDX-License-Identifier: MIT
// A made-up episode for the tests of this room: a robot walks through a house of boxes, up a
// flight, and is said to find three things. Depth is exact, the map is the real one, decisions are
// scripted. Deterministic, no files.
#pragma once

#include <optional>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/trace/replay.h"

namespace crossnav::trace {

struct SampleFrame {
  StepTrace trace;
  Observation observation;
  Sight sight;                     ///< of the house: stairs, the last pieces of furniture
  std::optional<GraphNote> graph;  ///< in some steps
};

struct SampleEpisode {
  ReplayInfo info;
  std::vector<SampleFrame> frames;
  std::vector<StageResult> stages;  ///< to be written after the frame of `last_step`
};

/// `image_px` is the size of the square camera image.
SampleEpisode MakeSampleEpisode(int image_px);

}  // namespace crossnav::trace
