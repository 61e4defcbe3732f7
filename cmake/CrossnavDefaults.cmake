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

find_program(CROSSNAV_CCACHE ccache)
if(CROSSNAV_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CROSSNAV_CCACHE}")
endif()

# FMA contraction would make the same seed give other bytes on another CPU.
add_compile_options(-ffp-contract=off)

if(CROSSNAV_SANITIZE)
  add_compile_options(-fsanitize=${CROSSNAV_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${CROSSNAV_SANITIZE})
endif()
