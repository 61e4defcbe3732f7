# SPDX-License-Identifier: MIT
# One test of ctest for each suite of a gtest program, as cmake -P after the program is linked: a process for each
# of the 1,400 tests would build the houses of their fixtures again and again. A suite is skipped when all of it is.
#   cmake -DPROGRAM=FILE -DTIMEOUT=SECONDS -DOUT=FILE.cmake -P CrossnavSuites.cmake
# PROGRAM lists its suites at the beginning of a line, "Suite." or "Suite/0.  # TypeParam = ...".
get_filename_component(folder "${PROGRAM}" DIRECTORY)
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests WORKING_DIRECTORY "${folder}" TIMEOUT 60
  OUTPUT_VARIABLE listed RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests: ${failed}\n${listed}")
endif()
string(REGEX MATCHALL "(^|\n)[^ \n]+\\.(  #[^\n]*)?\n  [^\n]+" suites "${listed}")
set(text "")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "^\n?([^ \n]+)\\..*" "\\1" name "${suite}")
  if(NOT name MATCHES "(^|/)DISABLED_")
    string(APPEND text "add_test([=[${name}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${name}.*]=] --gtest_brief=1)\n"
      "set_tests_properties([=[${name}]=] PROPERTIES TIMEOUT ${TIMEOUT} WORKING_DIRECTORY [=[${folder}]=]\n"
      "  SKIP_REGULAR_EXPRESSION [=[\\[  PASSED  \\] 0 tests]=])\n")
  endif()
endforeach()
if(text STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} has no tests")
endif()
file(WRITE "${OUT}" "${text}")
