// SPDX-License-Identifier: MIT
// Content of a replay: one episode, step by step (docs/formats/replay.md). ReplayWriter writes it,
// ReadReplay reads it, the page of replay_page.h shows it. World frame, metres. Its ground truth
// (goal boxes, outcomes) is for display and comes from the evaluator, never from the agent.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "crossnav/core/box.h"
#include "crossnav/core/image.h"
#include "crossnav/core/observation.h"
#include "crossnav/trace/graph_note.h"
#include "crossnav/trace/sight.h"
#include "crossnav/trace/step_trace.h"

namespace crossnav::trace {

inline constexpr int kReplayFormat = 1;
/// Duration of a step for viewers; steps have no clock.
inline constexpr std::uint64_t kStepNs = 100'000'000;

/// A true instance of a goal, for display.
struct GoalInstance {
  std::string goal;
  Box3 box;
};

/// Written once, before the first step.
struct ReplayInfo {
  std::string scene_id;
  std::string episode_id;
  std::vector<std::string> goals;  ///< in order
  std::string variant;
  std::string perception;
  std::string version;
  std::string config_hash;
  std::uint64_t seed = 0;
  double voxel_m = 0.10;
  std::vector<GoalInstance> goal_instances;
};

/// The evaluator's result of a goal, at its end.
struct StageResult {
  int goal_index = 0;
  std::string goal;
  std::string outcome;  ///< e.g. "success", "stop_out_of_range", "budget"
  bool success = false;
  int last_step = 0;
  double length_m = 0;
  double shortest_m = 0;
};

/// A step as input of the writer. `observation`, `sight` and `graph` may be null: the step then has
/// no images, no results of perception, or the graph of the step before it.
struct ReplayFrame {
  const StepTrace& trace;
  const Observation* observation = nullptr;
  const Sight* sight = nullptr;
  const GraphNote* graph = nullptr;  ///< where it changed in this step
};

/// A step as output of the reader.
struct ReplayStep {
  StepTrace trace;
  std::string image_jpeg;         ///< empty if not written
  Image<std::uint16_t> depth_mm;  ///< 0 = invalid; empty if not written
  std::optional<SightNote> sight;
  std::string maps_png;            ///< MapsOf the sight; empty if not written
  std::optional<GraphNote> graph;  ///< where it changed in this step
};

struct Replay {
  ReplayInfo info;
  std::vector<ReplayStep> steps;
  std::vector<StageResult> stages;
  bool is_complete = true;  ///< false: the file is truncated; `steps` ends at the tear
};

}  // namespace crossnav::trace
