# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The sources of a folder compiled as one unit, so that the headers that they share are read once: half of the time
# from scratch, but a change compiles its whole folder again. `make` asks for it where no compiler cache is found.
option(TALUS_BATCHES "Compile the sources of a folder as one unit" OFF)

# talus_batches(TARGET): the C++ sources of a target, one unit a folder; with them kernels (.cu) that the C++ compiler
# compiles. For GPUs each is a unit of its own. What a source keeps to itself thus has a name of its own in its folder.
function(talus_batches target)
  if(NOT TALUS_BATCHES)
    return()
  endif()
  get_target_property(_sources ${target} SOURCES)
  if(TALUS_WITH_CUDA)
    list(FILTER _sources INCLUDE REGEX "\\.cpp$")
  endif()
  foreach(_source IN LISTS _sources)
    cmake_path(ABSOLUTE_PATH _source OUTPUT_VARIABLE _folder)
    cmake_path(IS_PREFIX CMAKE_BINARY_DIR "${_folder}" _made)
    cmake_path(GET _folder PARENT_PATH _folder)
    if(_made)
      continue()
    endif()
    file(RELATIVE_PATH _folder ${CMAKE_SOURCE_DIR} ${_folder})
    string(MAKE_C_IDENTIFIER "${_folder}" _folder)
    set_source_files_properties(${_source} PROPERTIES UNITY_GROUP ${_folder})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
