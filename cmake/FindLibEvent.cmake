# SPDX-License-Identifier: MIT
# libevent's HTTP server without its TLS, as packaged (Debian has no CMake config): libevent::extra.
find_path(LibEvent_INCLUDE_DIR event2/http.h)
find_library(LibEvent_CORE_LIBRARY event_core)
find_library(LibEvent_EXTRA_LIBRARY event_extra)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LibEvent
  REQUIRED_VARS LibEvent_INCLUDE_DIR LibEvent_CORE_LIBRARY LibEvent_EXTRA_LIBRARY)
if(LibEvent_FOUND AND NOT TARGET libevent::extra)
  add_library(libevent::extra UNKNOWN IMPORTED)
  set_target_properties(libevent::extra PROPERTIES IMPORTED_LOCATION "${LibEvent_EXTRA_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${LibEvent_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${LibEvent_CORE_LIBRARY}")
endif()
mark_as_advanced(LibEvent_INCLUDE_DIR LibEvent_CORE_LIBRARY LibEvent_EXTRA_LIBRARY)
