# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# One interface target carries the warnings of all our own code; third-party headers are SYSTEM. With them all of it is
# clean of conversions that may change a value or a sign; kernels that nvcc compiles too (cmake/kernels.cmake).
add_library(talus_warnings INTERFACE)
set(_warnings -Wall -Wextra -Wnon-virtual-dtor -Woverloaded-virtual -Wconversion -Wsign-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND _warnings -Wno-restrict)   # GCC 12 sees overlaps in every "literal" + std::string (GCC PR 105651)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND _warnings -Wno-array-bounds)   # GCC 13 sees the copy of an empty std::vector reach beyond its end
endif()
# The same of a local name in every build: in a batch (cmake/batches.cmake) sources see what others of their folder
# declare, which -Wshadow alone would count; whether a compiler cache is there must not decide what compiles.
list(APPEND _warnings -Wshadow=local)
if(TALUS_BATCHES)   # sources are included files there
  list(APPEND _warnings -Wno-subobject-linkage)
endif()
if(TALUS_WERROR)
  list(APPEND _warnings -Werror)
endif()
target_compile_options(talus_warnings INTERFACE $<$<COMPILE_LANGUAGE:CXX>:${_warnings}>)
# Sanitizers. An undefined operation ends the test rather than being told of. FORTIFY and sanitizers do not go together.
if(TALUS_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "TALUS_FUZZ asks for clang, whose libFuzzer it uses: cmake --preset fuzz")
  endif()
  set(_sanitizers address,undefined,fuzzer-no-link)
  set(_without -fsanitize-ignorelist=${CMAKE_SOURCE_DIR}/tests/fuzz/ignored.txt)
elseif(TALUS_SANITIZE STREQUAL "THREAD")
  set(_sanitizers thread)
elseif(TALUS_SANITIZE)
  set(_sanitizers address,undefined)
  # Null pointers and sizes the address sanitizer sees too; without these checks a unit takes a third less to compile.
  set(_without -fno-sanitize=null,vptr,object-size)
endif()
if(_sanitizers)
  set(_flags -fsanitize=${_sanitizers} ${_without} -fno-sanitize-recover=all -fno-omit-frame-pointer
    -D_GLIBCXX_ASSERTIONS)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    list(APPEND _flags -Wno-maybe-uninitialized)   # GCC 12 sees it in std::regex where code is instrumented
  endif()
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:${_flags}>")
  add_link_options(-fsanitize=${_sanitizers})
endif()
