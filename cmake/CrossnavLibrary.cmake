# SPDX-License-Identifier: MIT
# crossnav_library(<room> SOURCES ... [DEPS <rooms>] [PUBLIC <targets>] [PRIVATE <targets>])
# A room is a static library crossnav::<room>. DEPS are the only other rooms it may include.
function(crossnav_warnings target)
  # GCC 12 warns falsely of overlap inside std::string (its bug 105329).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
  if(CROSSNAV_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

function(crossnav_library room)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PUBLIC;PRIVATE" ${ARGN})
  add_library(crossnav_${room} STATIC ${ARG_SOURCES})
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
  add_executable(test_${room} ${ARG_SOURCES})
  foreach(dep IN LISTS ARG_DEPS)
    target_link_libraries(test_${room} PRIVATE crossnav::${dep})
  endforeach()
  target_link_libraries(test_${room} PRIVATE ${ARG_LIBS} GTest::gtest_main)
  target_include_directories(test_${room} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  # Data supplied from outside the project; tests that need it are skipped if it is absent.
  target_compile_definitions(test_${room} PRIVATE
    CROSSNAV_SHARED_DIR="${PROJECT_SOURCE_DIR}/../shared"
    CROSSNAV_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
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
