// SPDX-License-Identifier: MIT
// The metrics of a set of records as text for a terminal and as JSON.
#pragma once

#include <span>
#include <string>

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {

/// Figures with their intervals, per category, per scene, per CFR group, and the outcome table.
/// Records of several tracks: all of it per track, and nothing pooled.
std::string MetricsText(std::span<const EpisodeRecord> episodes, const BootstrapConfig& bootstrap);

/// JSON object {episodes, goals, metrics: {name: {value, low, high}}, reached, groups: {name:
/// {...}}, scenes, categories: {name: {executed, sr, spl}}, outcomes: {category: {outcome:
/// count}}}. Records of several tracks: {episodes, tracks: {name: that object}}.
std::string MetricsJson(std::span<const EpisodeRecord> episodes, const BootstrapConfig& bootstrap);

/// A line per stage of one episode, and a line with the cause for a failed stage.
std::string EpisodeText(const EpisodeRecord& record);

}  // namespace crossnav::evaluation
