// SPDX-License-Identifier: MIT
// IFC files, read by IfcOpenShell in a Python of the user's, with limits of time and memory.
#pragma once

#include <string>
#include <string_view>

#include "crossnav/core/result.h"

namespace crossnav::app {

/// The text of ifc_reader.py.
std::string_view IfcReader();

/// The building in an IFC file, as docs/formats/building.md has it. The Python is that of
/// CROSSNAV_PYTHON, else the one that `scripts/setup.sh ifc` made, else python3. `seconds` of
/// processor time are what it may take.
Result<std::string> ReadIfc(const std::string& file, int seconds);

}  // namespace crossnav::app
