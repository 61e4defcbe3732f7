// SPDX-License-Identifier: MIT
// Version of the library, the program and the Python package. CMakeLists.txt and pyproject.toml
// read it from here.
#pragma once

#define CROSSNAV_VERSION "0.2.0"
#define CROSSNAV_VERSION_MAJOR 0
#define CROSSNAV_VERSION_MINOR 2
#define CROSSNAV_VERSION_PATCH 0
