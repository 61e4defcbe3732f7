// SPDX-License-Identifier: MIT
// `map build`: makes a map file from a sensor's recording, and answers a text as `map query` does.
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "crossnav/recordings/recording.h"

namespace crossnav::app {

struct MapBuildOptions {
  std::string from, out;
  std::string goal;        ///< object to search in the map; empty = none
  std::string perception;  ///< none | networks; empty = derived from goal and networks
  std::string networks;    ///< preset, as in LoadWithNetworks
  int top = 4;             ///< as in MapOptions
  recordings::RecordingOptions recording;            ///< without the numbers typed below
  std::vector<double> intrinsics, depth_intrinsics;  ///< fx, fy, cx, cy [px]; empty = not given
  std::vector<double> extrinsics, mount;             ///< x, y, z [m], qx, qy, qz, qw; likewise
  double pose_gap_s = 0.5;
};
Result<void> MapBuild(const MapBuildOptions& options, const CommonOptions& common,
                      Console& console);

/// Result of a query, as text and as JSON.
struct MapAnswer {
  std::string text, json;
};
/// The places in `options.file` that answer `options.text`.
Result<MapAnswer> AnswerQuery(const MapOptions& options, const evaluation::RunConfig& config,
                              Console& console);

}  // namespace crossnav::app
