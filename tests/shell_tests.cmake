# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# talus_shell_tests(FILE... [QUICK FILE...]): every function test_NAME() of a *_test.sh becomes a CTest test, those of
# the quick files with that label. Exit code 77 is a skip. Where a file has test_is_made(), its others come after that
# one and look at what it has left (tests/lib.sh).
find_program(TALUS_BASH bash REQUIRED)

function(talus_shell_tests)
  cmake_parse_arguments(_asked "" "" "QUICK" ${ARGN})
  foreach(_file IN LISTS _asked_UNPARSED_ARGUMENTS _asked_QUICK)
    set(_path ${CMAKE_CURRENT_SOURCE_DIR}/${_file})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${_path})
    get_filename_component(_group ${CMAKE_CURRENT_SOURCE_DIR} NAME)
    string(REGEX REPLACE "_test\\.sh$" "" _subject ${_file})
    file(STRINGS ${_path} _functions REGEX "^test_[a-z0-9_]+\\(\\)")
    foreach(_function IN LISTS _functions)
      string(REGEX REPLACE "^test_([a-z0-9_]+).*" "\\1" _case ${_function})
      set(_name ${_group}.${_subject}.${_case})
      add_test(NAME ${_name} COMMAND ${TALUS_BASH} ${_path} ${_case})
      set(_variables TALUS_SOURCE=${CMAKE_SOURCE_DIR} TALUS_BUILD=${CMAKE_BINARY_DIR}
        TALUS_SCRATCH=${CMAKE_BINARY_DIR}/scratch/${_name})
      set_tests_properties(${_name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 ENVIRONMENT "${_variables}")
      if(_case STREQUAL is_made)
        set_tests_properties(${_name} PROPERTIES FIXTURES_SETUP ${_group}.${_subject})
      elseif(_functions MATCHES "test_is_made")
        set_tests_properties(${_name} PROPERTIES FIXTURES_REQUIRED ${_group}.${_subject})
      endif()
      if(_file IN_LIST _asked_QUICK)
        set_tests_properties(${_name} PROPERTIES LABELS quick)
      endif()
    endforeach()
  endforeach()
endfunction()
