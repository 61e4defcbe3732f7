// SPDX-License-Identifier: MIT
// The version of the library, of the program and of the Python package. CMakeLists.txt and
// pyproject.toml read it here.
#pragma once

#define CROSSNAV_VERSION "0.2.0"
#define CROSSNAV_VERSION_MAJOR 0
#define CROSSNAV_VERSION_MINOR 2
#define CROSSNAV_VERSION_PATCH 0
