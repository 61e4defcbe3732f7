// SPDX-License-Identifier: MIT
// Locates OpenVINO at run time: in CROSSNAV_OPENVINO, beside an installed Python package, in a
// Python environment, in the folder of scripts/setup.sh, or on the system's library path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/inference/openvino_plugin.h"

namespace crossnav::inference {

struct OpenVinoLibrary {
  const OpenVinoPlugin* plugin = nullptr;  ///< null if missing
  std::string missing;                     ///< remedy, for messages
};

/// Located at the first call, once a process.
const OpenVinoLibrary& TheOpenVino();

/// Folders that may hold OpenVINO's libraries, in search order. `program_dir` is the folder of the
/// running program.
std::vector<std::filesystem::path> OpenVinoFolders(const std::filesystem::path& program_dir);

}  // namespace crossnav::inference
