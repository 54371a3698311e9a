# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DPROGRAM= -DOUT= -DPREFIX= -DLEFT_OUT=pattern:pattern -DTIMEOUT= -P discover_suites.cmake
# A CTest test for each suite of a GoogleTest program, all of its cases in one process: to start a program that links
# GDAL takes longer than most cases do. LEFT_OUT are cases that other tests run.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests "--gtest_filter=-${LEFT_OUT}" OUTPUT_VARIABLE _listed
  COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\." _suites "${_listed}")
set(_tests "")
foreach(_suite IN LISTS _suites)
  string(REGEX REPLACE "[\n.]" "" _suite "${_suite}")
  set(_name "[==[${PREFIX}${_suite}]==]")
  string(APPEND _tests "add_test(${_name} [==[${PROGRAM}]==] [==[--gtest_filter=${_suite}.*:-${LEFT_OUT}]==])\n"
    "set_tests_properties(${_name} PROPERTIES TIMEOUT ${TIMEOUT} LABELS quick)\n")
endforeach()
file(WRITE ${OUT} "${_tests}")
