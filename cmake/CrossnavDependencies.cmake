# SPDX-License-Identifier: MIT
# Every third-party library, from distribution packages (scripts/setup.sh installs them).
include(CrossnavLibraries)
# Libraries of the program, and of rooms that are not installed.
crossnav_find(CLI11 CLI11::CLI11 HEADER CLI/CLI.hpp)
crossnav_find(pugixml pugixml::pugixml HEADER pugixml.hpp LIBRARY pugixml)
find_package(Protobuf REQUIRED)
find_package(LibEvent REQUIRED)
find_package(OpenVinoWheel)
find_package(OnnxRuntime 1.18)
find_package(BasisUniversal)
if(NOT BasisUniversal_FOUND)
  message(STATUS "No Basis Universal: HM3D's .basis textures are left out; scripts/setup.sh hm3d compiles it")
endif()
if(NOT OpenVinoWheel_FOUND AND NOT OnnxRuntime_FOUND)
  message(STATUS "No OpenVINO and no ONNX Runtime: perception by networks is left out; "
    "scripts/setup.sh fetches OpenVINO, docs/networks.md says how to have the other")
endif()
if(CROSSNAV_BUILD_TESTS)
  crossnav_find(GTest GTest::gtest_main)
endif()
