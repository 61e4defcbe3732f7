# SPDX-License-Identifier: MIT
# ONNX Runtime's C++ header and library: OnnxRuntime::OnnxRuntime. From the distribution
# (libonnxruntime-dev of Debian 13), or from ONNXRUNTIME_ROOT, a CMake or an environment variable: a
# folder with include/ and lib/, the layout of ONNX Runtime's own releases.
set(ONNXRUNTIME_ROOT "" CACHE PATH "Folder with ONNX Runtime's include and lib; empty = the system's")
set(onnxruntime_root "${ONNXRUNTIME_ROOT}")
if(NOT onnxruntime_root)
  set(onnxruntime_root "$ENV{ONNXRUNTIME_ROOT}")
endif()
set(onnxruntime_only "")
if(onnxruntime_root)
  set(onnxruntime_only PATHS "${onnxruntime_root}" NO_DEFAULT_PATH)
endif()

# Not cached: the next configuration finds a later installation or another root.
unset(OnnxRuntime_INCLUDE_DIR)
unset(OnnxRuntime_LIBRARY)
find_path(OnnxRuntime_INCLUDE_DIR onnxruntime_cxx_api.h NO_CACHE ${onnxruntime_only}
  PATH_SUFFIXES include include/onnxruntime onnxruntime include/onnxruntime/core/session
                onnxruntime/core/session)
find_library(OnnxRuntime_LIBRARY onnxruntime NO_CACHE ${onnxruntime_only} PATH_SUFFIXES lib lib64)
if(OnnxRuntime_INCLUDE_DIR)
  file(STRINGS "${OnnxRuntime_INCLUDE_DIR}/onnxruntime_c_api.h" onnxruntime_api
    REGEX "^#define ORT_API_VERSION ")
  string(REGEX REPLACE "[^0-9]" "" onnxruntime_api "${onnxruntime_api}")
  set(OnnxRuntime_VERSION "1.${onnxruntime_api}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OnnxRuntime
  REQUIRED_VARS OnnxRuntime_INCLUDE_DIR OnnxRuntime_LIBRARY VERSION_VAR OnnxRuntime_VERSION)
if(OnnxRuntime_FOUND AND NOT TARGET OnnxRuntime::OnnxRuntime)
  add_library(OnnxRuntime::OnnxRuntime UNKNOWN IMPORTED GLOBAL)
  set_target_properties(OnnxRuntime::OnnxRuntime PROPERTIES
    IMPORTED_LOCATION "${OnnxRuntime_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OnnxRuntime_INCLUDE_DIR}")
endif()
