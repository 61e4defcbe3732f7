# SPDX-License-Identifier: MIT
# OpenVINO's headers and libraries from its Python wheel: OpenVinoWheel::OpenVinoWheel. Searches the
# folder of scripts/setup.sh for the pinned version, or OPENVINO_ROOT (the folder with
# openvino/include and openvino/libs). The wheel's own CMake config is not used, because it must be
# the only package that finds TBB.
file(STRINGS "${PROJECT_SOURCE_DIR}/scripts/openvino.txt" openvino_pin REGEX "^openvino==")
string(REGEX REPLACE "^openvino==([0-9.]+).*" "\\1" OpenVinoWheel_VERSION "${openvino_pin}")
set(openvino_data "$ENV{XDG_DATA_HOME}")
if(NOT openvino_data)
  set(openvino_data "$ENV{HOME}/.local/share")
endif()
set(OPENVINO_ROOT "" CACHE PATH "Folder with openvino/include and openvino/libs; empty = setup.sh's")
set(openvino_root "${OPENVINO_ROOT}")
if(NOT openvino_root)
  set(openvino_root "${openvino_data}/crossnav/openvino-${OpenVinoWheel_VERSION}")
endif()

# Not cached: the next configuration finds a later installation.
set(OpenVinoWheel_INCLUDE_DIR "")
if(EXISTS "${openvino_root}/openvino/include/openvino/openvino.hpp")
  set(OpenVinoWheel_INCLUDE_DIR "${openvino_root}/openvino/include")
endif()
file(GLOB OpenVinoWheel_LIBRARY "${openvino_root}/openvino/libs/libopenvino.so.*")
file(GLOB OpenVinoWheel_TBB "${openvino_root}/openvino/libs/libtbb.so.12")
set(OpenVinoWheel_LIBS "${openvino_root}/openvino/libs" CACHE INTERNAL "For scripts/portable_wheels.sh")
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenVinoWheel
  REQUIRED_VARS OpenVinoWheel_INCLUDE_DIR OpenVinoWheel_LIBRARY OpenVinoWheel_TBB
  VERSION_VAR OpenVinoWheel_VERSION)
if(OpenVinoWheel_FOUND AND NOT TARGET OpenVinoWheel::OpenVinoWheel)
  add_library(OpenVinoWheel::OpenVinoWheel INTERFACE IMPORTED GLOBAL)
  target_include_directories(OpenVinoWheel::OpenVinoWheel SYSTEM INTERFACE
    "${OpenVinoWheel_INCLUDE_DIR}")
  target_link_libraries(OpenVinoWheel::OpenVinoWheel INTERFACE
    "${OpenVinoWheel_LIBRARY}" "${OpenVinoWheel_TBB}")
endif()
