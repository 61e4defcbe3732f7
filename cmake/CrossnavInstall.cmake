# SPDX-License-Identifier: MIT
# `cmake --install`: archives, headers and a CMake package (docs/cpp.md), component `development`.
# Rooms used by the program only are not installed. The program is component `program`.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/crossnav")

install(TARGETS ${room_targets} EXPORT crossnav-targets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
install(EXPORT crossnav-targets NAMESPACE crossnav::
  DESTINATION "${package_dir}" COMPONENT development)
foreach(room IN LISTS rooms)
  install(DIRECTORY crossnav/${room} DESTINATION include/crossnav COMPONENT development
    FILES_MATCHING PATTERN "*.h" PATTERN proto EXCLUDE PATTERN schema EXCLUDE)
endforeach()
# Settings of rooms that are not installed, needed by `evaluation`.
install(FILES crossnav/inference/networks_config.h
  DESTINATION include/crossnav/inference COMPONENT development)
install(FILES crossnav/serve/serve_config.h
  DESTINATION include/crossnav/serve COMPONENT development)

configure_package_config_file(cmake/crossnav-config.cmake.in crossnav-config.cmake
  INSTALL_DESTINATION "${package_dir}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(crossnav-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_BINARY_DIR}/crossnav-config.cmake" "${PROJECT_BINARY_DIR}/crossnav-config-version.cmake"
  cmake/CrossnavLibraries.cmake cmake/FindRecastNavigation.cmake cmake/FindXxHash.cmake
  cmake/FindLibZip.cmake
  DESTINATION "${package_dir}" COMPONENT development)
if(BasisUniversal_FOUND)
  get_target_property(transcoder BasisUniversal::Transcoder IMPORTED_LOCATION)
  install(FILES "${transcoder}" DESTINATION "${package_dir}" COMPONENT development)
endif()
