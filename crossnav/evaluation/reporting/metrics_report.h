// SPDX-License-Identifier: MIT
// The metrics of a set of records as text for a terminal and as JSON.
#pragma once

#include <span>
#include <string>

#include "crossnav/evaluation/records/episode_record.h"
#include "crossnav/evaluation/scoring/metrics.h"

namespace crossnav::evaluation {

/// Figures with their intervals, per category, per scene, per CFR group, and the outcome table.
/// Where records are of several tracks, all of it for each of them, and nothing pooled.
std::string MetricsText(std::span<const EpisodeRecord> episodes, const BootstrapConfig& bootstrap);

/// The same as one JSON object:
/// {episodes, goals, metrics: {name: {value, low, high}}, reached, groups: {name: {...}},
///  scenes, categories: {name: {executed, sr, spl}}, outcomes: {category: {outcome: count}}}.
/// Where records are of several tracks, {episodes, tracks: {name: that object}}.
std::string MetricsJson(std::span<const EpisodeRecord> episodes, const BootstrapConfig& bootstrap);

/// One line per stage of one episode, and one of cause for a stage that failed.
std::string EpisodeText(const EpisodeRecord& record);

}  // namespace crossnav::evaluation
