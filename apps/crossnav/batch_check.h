// SPDX-License-Identifier: MIT
// Measures a network with batches of 1, 2, 4, ... frames, alone and under that many agents in
// threads, and compares its outputs with those for single frames (`networks check`).
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "crossnav/core/result.h"
#include "crossnav/inference/model_card.h"
#include "crossnav/inference/networks_config.h"
#include "crossnav/perception/perception.h"

namespace crossnav::app {

struct BatchTime {
  int frames = 0;         ///< of a batch, and agents
  double network_ms = 0;  ///< of the network alone, a frame
  double agents_ms = 0;   ///< of `frames` agents with their own pictures, a frame
};

/// Largest absolute difference of an output between two runs of the same frames.
struct OutputDifference {
  std::string output;
  double most = 0;   ///< of the difference
  double range = 0;  ///< largest absolute value of the output
};

struct BatchCheck {
  std::vector<BatchTime> times;            ///< empty: the file takes one frame at a time
  std::vector<OutputDifference> from_one;  ///< largest batch against single frames
  std::vector<OutputDifference> from_cpu;  ///< the same against the CPU; empty on the CPU
};

/// An agent's work on its picture number `frame`, in a thread of its own.
using AgentFrame =
    std::function<Result<void>(const perception::PerceptionSuite& suite, int agent, int frame)>;

/// Batches up to `settings.batch` frames, with suites of `settings`, of which all parts are of
/// `card`. Errors as of opening and running the network.
Result<BatchCheck> CheckBatches(const inference::ModelCard& card,
                                const inference::NetworksConfig& settings, double camera_height_m,
                                const AgentFrame& work);

/// A table and a line for each comparison.
std::string BatchText(const BatchCheck& check);
nlohmann::ordered_json BatchJson(const BatchCheck& check);

}  // namespace crossnav::app
