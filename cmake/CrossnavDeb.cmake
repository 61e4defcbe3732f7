# SPDX-License-Identifier: MIT
# `cpack` in the build folder (`make packages`): the program as a Debian package with the libraries that it
# needs, for this distribution and newer ones (docs/install.md).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME crossnav)
set(CPACK_PACKAGE_CONTACT "the crossnav authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Sequential object-goal navigation across floors")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program bundle)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Bundles its libraries, except for the libraries of the C and C++ compilers.
execute_process(COMMAND getconf GNU_LIBC_VERSION OUTPUT_VARIABLE glibc OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REGEX REPLACE "[^0-9.]" "" glibc "${glibc}")
string(REGEX MATCH "^[0-9]+" gcc "${CMAKE_CXX_COMPILER_VERSION}")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libc6 (>= ${glibc}), libstdc++6 (>= ${gcc})")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/ATTRIBUTION.md"
  DESTINATION share/doc/crossnav COMPONENT program)
include(CPack)
