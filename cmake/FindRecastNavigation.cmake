# SPDX-License-Identifier: MIT
# Recast and Detour as packaged (no CMake config of their own): RecastNavigation::{Recast,Detour}.
find_path(RecastNavigation_INCLUDE_DIR recastnavigation/Recast.h)
find_library(RecastNavigation_Recast_LIBRARY Recast)
find_library(RecastNavigation_Detour_LIBRARY Detour)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(RecastNavigation REQUIRED_VARS RecastNavigation_INCLUDE_DIR
  RecastNavigation_Recast_LIBRARY RecastNavigation_Detour_LIBRARY)
foreach(part Recast Detour)
  if(RecastNavigation_FOUND AND NOT TARGET RecastNavigation::${part})
    add_library(RecastNavigation::${part} UNKNOWN IMPORTED)
    set_target_properties(RecastNavigation::${part} PROPERTIES
      IMPORTED_LOCATION "${RecastNavigation_${part}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${RecastNavigation_INCLUDE_DIR}")
  endif()
endforeach()
mark_as_advanced(RecastNavigation_INCLUDE_DIR RecastNavigation_Recast_LIBRARY
  RecastNavigation_Detour_LIBRARY)
