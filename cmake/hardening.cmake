# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# A program that writes beyond its bounds ends there: lengths in calls of the C library are checked (FORTIFY), and a
# mark before the return address of functions that hold arrays. What it costs: docs/explanation/reliability.md.
# Sanitizers see more and do not go together with FORTIFY; kernels that nvcc compiles are left as they are. Containers
# check their indices in the configuration Debug, as they do under sanitizers.
option(TALUS_HARDEN "Checked calls of the C library, protected stacks" ON)
set(TALUS_HARDENED OFF)
if(TALUS_HARDEN AND NOT TALUS_SANITIZE AND NOT TALUS_FUZZ AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(TALUS_HARDENED ON)
  add_compile_options("$<$<COMPILE_LANGUAGE:C,CXX>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3;-fstack-protector-strong>")
endif()
add_compile_options("$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Debug>>:-D_GLIBCXX_ASSERTIONS>")
