# SPDX-License-Identifier: MIT
# Language level, default build type, warnings, sanitizers, compiler cache.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# Objects contain no path of this checkout, so that the compiler cache hits from other checkouts and
# a wheel of them is the same everywhere. ccache achieves it by naming sources relatively.
find_program(CROSSNAV_CCACHE ccache)
if(CROSSNAV_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
    "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1 "${CROSSNAV_CCACHE}")
else()
  add_compile_options("-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=")
endif()

# FMA contraction would change results from CPU to CPU.
add_compile_options(-ffp-contract=off)

if(CROSSNAV_SANITIZE)
  add_compile_options(-fsanitize=${CROSSNAV_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${CROSSNAV_SANITIZE})
endif()
