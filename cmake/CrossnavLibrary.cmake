# SPDX-License-Identifier: MIT
# crossnav_library(<room> SOURCES ... [DEPS <rooms>] [PUBLIC <targets>] [PRIVATE <targets>])
# A room is a static library crossnav::<room>. DEPS are the only other rooms it may include.
function(crossnav_warnings target)
  # GCC 12 warns falsely of overlap inside std::string (its bug 105329).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  # A source that another one includes is no header.
  if(CROSSNAV_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
  if(CROSSNAV_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# crossnav_joined(<result> <target> <sources>...): with CROSSNAV_UNITY, files that include CROSSNAV_UNITY_FILES sources
# each, so that a header is parsed once for all. Highway's kernels and generated sources stay alone. CMake's own unity
# files have absolute paths, which keep their objects out of the compiler cache of another checkout.
function(crossnav_joined result target)
  if(NOT CROSSNAV_UNITY)
    set(${result} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  set(alone "")
  set(joined "")
  foreach(source IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" OUTPUT_VARIABLE path)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR "${path}" is_alone)
    if(NOT is_alone)
      file(STRINGS "${path}" is_alone REGEX "hwy/foreach_target.h")
    endif()
    if(is_alone)
      list(APPEND alone "${source}")
    else()
      cmake_path(RELATIVE_PATH path BASE_DIRECTORY "${PROJECT_SOURCE_DIR}")
      list(APPEND joined "${path}")
    endif()
  endforeach()
  set(number 0)
  while(joined)
    list(SUBLIST joined 0 ${CROSSNAV_UNITY_FILES} part)
    list(REMOVE_ITEM joined ${part})
    list(TRANSFORM part REPLACE "(.+)" "#include \"\\1\"")
    list(JOIN part "\n" text)
    math(EXPR number "${number} + 1")
    set(file "${CMAKE_CURRENT_BINARY_DIR}/${target}_${number}.cpp")
    file(CONFIGURE OUTPUT "${file}" CONTENT "${text}\n")
    list(APPEND alone "${file}")
  endwhile()
  set(${result} ${alone} PARENT_SCOPE)
endfunction()

function(crossnav_library room)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PUBLIC;PRIVATE" ${ARGN})
  crossnav_joined(sources ${room} ${ARG_SOURCES})
  add_library(crossnav_${room} STATIC ${sources})
  add_library(crossnav::${room} ALIAS crossnav_${room})
  set_target_properties(crossnav_${room} PROPERTIES EXPORT_NAME ${room})
  target_include_directories(crossnav_${room} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include>)
  target_compile_features(crossnav_${room} PUBLIC cxx_std_20)
  foreach(dep IN LISTS ARG_DEPS)
    target_link_libraries(crossnav_${room} PUBLIC crossnav::${dep})
  endforeach()
  target_link_libraries(crossnav_${room} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  crossnav_warnings(crossnav_${room})
endfunction()

# crossnav_test(<room> SOURCES ... [DEPS <rooms>] [LIBS <targets>] [TIMEOUT <s>]): one program
# test_<room>; TIMEOUT is that of a suite.
function(crossnav_test room)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;DEPS;LIBS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(CROSSNAV_SANITIZE)
    math(EXPR ARG_TIMEOUT "4 * ${ARG_TIMEOUT}")  # which slow programs down many times
  endif()
  crossnav_joined(sources test_${room} ${ARG_SOURCES})
  add_executable(test_${room} ${sources})
  foreach(dep IN LISTS ARG_DEPS)
    target_link_libraries(test_${room} PRIVATE crossnav::${dep})
  endforeach()
  target_link_libraries(test_${room} PRIVATE ${ARG_LIBS} crossnav_places GTest::gtest_main)
  target_include_directories(test_${room} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  crossnav_warnings(test_${room})
  crossnav_suites(test_${room} ${ARG_TIMEOUT})
endfunction()

# crossnav_suites(<target> <seconds>): the suites of a gtest program as tests of ctest.
function(crossnav_suites target timeout)
  set(script "${PROJECT_SOURCE_DIR}/cmake/CrossnavSuites.cmake")
  set(suites "${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake")
  set(include "${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake")
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND "${CMAKE_COMMAND}" "-DPROGRAM=$<TARGET_FILE:${target}>" -DTIMEOUT=${timeout} "-DOUT=${suites}"
            -P "${script}"
    BYPRODUCTS "${suites}"
    VERBATIM)
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS "${script}")
  file(WRITE "${include}" "if(EXISTS [=[${suites}]=])\n  include([=[${suites}]=])\nelse()\n"
    "  add_test(${target}_NOT_BUILT ${target}_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${include}")
endfunction()

# The test `viewer.NAME` of the replay page: viewer/test/NAME.test.mjs under Node.js, with ENVIRONMENT and the other
# properties of PROPERTIES. ctest reports it as skipped where Node.js or all that the file needs is not installed.
function(crossnav_page_test name)
  find_program(NODE_PROGRAM NAMES node nodejs)
  if(NODE_PROGRAM)
    add_test(NAME viewer.${name}
      COMMAND "${NODE_PROGRAM}" --test "${PROJECT_SOURCE_DIR}/viewer/test/${name}.test.mjs")
  else()
    add_test(NAME viewer.${name} COMMAND "${CMAKE_COMMAND}" -E echo "no Node.js; run scripts/setup.sh viewer")
  endif()
  set_tests_properties(viewer.${name} PROPERTIES TIMEOUT 300
    SKIP_REGULAR_EXPRESSION "^no Node.js;pass 0\n[^\n]*fail 0\n[^\n]*cancelled 0\n[^\n]*skipped [1-9]" ${ARGN})
endfunction()
