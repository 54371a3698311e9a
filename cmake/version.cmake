# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The commit that --version names; "unknown" outside a git checkout. It is taken when CMake configures, and what git
# writes with every commit and checkout makes it configure anew.
execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} rev-parse --short=9 HEAD
  OUTPUT_VARIABLE TALUS_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT TALUS_COMMIT)
  set(TALUS_COMMIT unknown)
endif()
execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} rev-parse --git-path logs/HEAD
  OUTPUT_VARIABLE _moves OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(_moves)
  get_filename_component(_moves "${_moves}" ABSOLUTE BASE_DIR ${CMAKE_SOURCE_DIR})
  if(EXISTS "${_moves}")
    set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${_moves}")
  endif()
endif()
