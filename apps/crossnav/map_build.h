// SPDX-License-Identifier: MIT
// `map build`: a map file of a sensor's recording, and the answer to a text as `map query` has it.
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "crossnav/recordings/recording.h"

namespace crossnav::app {

struct MapBuildOptions {
  std::string from, out;
  std::string goal;                        ///< what to look for in the map; empty = nothing
  std::string perception;                  ///< none | networks; empty = as goal and networks say
  std::string networks;                    ///< preset, as in LoadWithNetworks
  int top = 4;                             ///< as in MapOptions
  recordings::RecordingOptions recording;  ///< but for what is typed as numbers:
  std::vector<double> intrinsics, depth_intrinsics;  ///< fx, fy, cx, cy [px]; empty = not given
  std::vector<double> extrinsics, mount;             ///< x, y, z [m], qx, qy, qz, qw; likewise
  double pose_gap_s = 0.5;
};
Result<void> MapBuild(const MapBuildOptions& options, const CommonOptions& common,
                      Console& console);

/// What a query found, for people and for machines.
struct MapAnswer {
  std::string text, json;
};
/// The places in `options.file` that answer `options.text`.
Result<MapAnswer> AnswerQuery(const MapOptions& options, const evaluation::RunConfig& config,
                              Console& console);

}  // namespace crossnav::app
