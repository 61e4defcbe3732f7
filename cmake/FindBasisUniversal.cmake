# SPDX-License-Identifier: MIT
# Basis Universal as compiled by scripts/setup.sh hm3d: BasisUniversal::Transcoder, and
# BasisUniversal::Encoder for tests. Searches the folder of setup.sh for the pinned version, or
# BASIS_UNIVERSAL_ROOT.
file(STRINGS "${PROJECT_SOURCE_DIR}/scripts/basis/Cargo.toml" basis_pin REGEX "^basis-universal-sys")
string(REGEX REPLACE ".*=([0-9.]+).*" "\\1" BasisUniversal_VERSION "${basis_pin}")
set(basis_data "$ENV{XDG_DATA_HOME}")
if(NOT basis_data)
  set(basis_data "$ENV{HOME}/.local/share")
endif()
set(BASIS_UNIVERSAL_ROOT "" CACHE PATH "Folder with libbasisu_transcoder.a; empty = setup.sh's")
set(basis_root "${BASIS_UNIVERSAL_ROOT}")
if(NOT basis_root)
  set(basis_root "${basis_data}/crossnav/basis-universal-${BasisUniversal_VERSION}")
endif()

# Not cached: the next configuration finds a later build.
set(BasisUniversal_LIBRARY "")
if(EXISTS "${basis_root}/libbasisu_transcoder.a")
  set(BasisUniversal_LIBRARY "${basis_root}/libbasisu_transcoder.a")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BasisUniversal REQUIRED_VARS BasisUniversal_LIBRARY
  VERSION_VAR BasisUniversal_VERSION)
if(BasisUniversal_FOUND AND NOT TARGET BasisUniversal::Transcoder)
  find_package(Threads REQUIRED)
  foreach(part Transcoder Encoder)
    string(TOLOWER ${part} name)
    add_library(BasisUniversal::${part} STATIC IMPORTED GLOBAL)
    set_target_properties(BasisUniversal::${part} PROPERTIES
      IMPORTED_LOCATION "${basis_root}/libbasisu_${name}.a"
      INTERFACE_INCLUDE_DIRECTORIES "${basis_root}/include"
      INTERFACE_COMPILE_DEFINITIONS "BASISD_SUPPORT_KTX2_ZSTD=1;BASISU_SUPPORT_SSE=0;BASISU_SUPPORT_OPENCL=0")
  endforeach()
  target_link_libraries(BasisUniversal::Transcoder INTERFACE zstd::libzstd_shared)
  target_link_libraries(BasisUniversal::Encoder INTERFACE
    BasisUniversal::Transcoder zstd::libzstd_shared Threads::Threads)
endif()
