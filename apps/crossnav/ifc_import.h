// SPDX-License-Identifier: MIT
// IFC files, read by IfcOpenShell in a Python of the user's, with limits of time and memory.
#pragma once

#include <string>
#include <string_view>

#include "child_work.h"
#include "crossnav/core/result.h"

namespace crossnav::app {

/// The text of ifc_reader.py.
std::string_view IfcReader();

/// Of a whole import: processor time of the reader, and when all of it ends by the clock.
struct IfcLimit {
  int seconds = 0;
  Deadline deadline = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
};

/// What is said where the limit was too short.
Error TooLate(const std::string& file, const IfcLimit& limit);

/// The building in an IFC file, as docs/formats/building.md has it. The Python is that of
/// CROSSNAV_PYTHON, else the one that `scripts/setup.sh ifc` made, else python3.
Result<std::string> ReadIfc(const std::string& file, const IfcLimit& limit);

}  // namespace crossnav::app
