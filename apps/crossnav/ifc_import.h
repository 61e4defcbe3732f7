// SPDX-License-Identifier: MIT
// Reads IFC files by IfcOpenShell in the user's Python, with limits of time and memory.
#pragma once

#include <string>
#include <string_view>

#include "child_work.h"
#include "crossnav/core/result.h"

namespace crossnav::app {

/// The text of ifc_reader.py.
std::string_view IfcReader();

/// Limits of an import: processor time of the reader, and a deadline in wall time for the whole.
struct IfcLimit {
  int seconds = 0;
  Deadline deadline = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
};

/// Error for an exceeded limit.
Error TooLate(const std::string& file, const IfcLimit& limit);

/// The building in an IFC file, in the format of docs/formats/building.md. The Python is
/// CROSSNAV_PYTHON, else the environment of `scripts/setup.sh ifc`, else python3.
Result<std::string> ReadIfc(const std::string& file, const IfcLimit& limit);

}  // namespace crossnav::app
