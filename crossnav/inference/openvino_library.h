// SPDX-License-Identifier: MIT
// OpenVINO as found at run time: in CROSSNAV_OPENVINO, beside an installed Python package, in a
// Python environment, where scripts/setup.sh puts it, or on the system's own library path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "crossnav/inference/openvino_plugin.h"

namespace crossnav::inference {

struct OpenVinoLibrary {
  const OpenVinoPlugin* plugin = nullptr;  ///< null where there is none
  std::string missing;                     ///< what to do then, for messages
};

/// Found at the first call, once a process.
const OpenVinoLibrary& TheOpenVino();

/// Folders that may hold OpenVINO's libraries, in the order in which they are tried. `program_dir`
/// is the folder of the running program.
std::vector<std::filesystem::path> OpenVinoFolders(const std::filesystem::path& program_dir);

}  // namespace crossnav::inference
