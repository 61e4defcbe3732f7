// SPDX-License-Identifier: MIT
// `serve`: the agent behind a local socket (docs/live.md).
#pragma once

#include <string>

#include "commands.h"

namespace crossnav::app {

struct ServeOptions {
  std::string socket;                   ///< path; empty = the default path, unless `port` is given
  int port = -1;                        ///< TCP on loopback, 0 = any free port; -1 = none
  std::string perception = "networks";  ///< networks | none
  std::string networks;                 ///< preset, as in LoadWithNetworks
  std::string memory;                   ///< map file to start from; empty = none
  std::string pose;                     ///< unknown = to be found in that map; empty = given
  std::string save_map;                 ///< map file to save the memory to at the end; empty = none
  WatchOptions watch;
};
Result<void> ServeLive(const ServeOptions& options, const CommonOptions& common, Console& console);

}  // namespace crossnav::app
