# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# How a kernel file (.cu) is compiled: by nvcc where kernels are wanted, by the host compiler otherwise. The code for
# both devices lives in one binary; TALUS_WITH_CUDA says whether that for GPUs is there.
#
# For which GPUs: those that CUDAARCHS or CMAKE_CUDA_ARCHITECTURES names; else, with TALUS_CUDA=AUTO, those of this
# machine, and none where it has none; with TALUS_CUDA=ON and for bundles (TALUS_ALL_GPUS) all that are supported.
option(TALUS_ALL_GPUS "Compile the kernels for every supported GPU" OFF)
# Ampere (and, by binary compatibility, Ada) and Hopper, with PTX for later ones.
set(TALUS_SUPPORTED_GPUS "80-real;90")

set(TALUS_WITH_CUDA OFF)
set(_kernels_for none)
if(NOT TALUS_CUDA STREQUAL "OFF")
  include(CheckLanguage)
  if(NOT CMAKE_CUDA_COMPILER AND EXISTS /usr/local/cuda/bin/nvcc)
    set(CMAKE_CUDA_COMPILER /usr/local/cuda/bin/nvcc)
  endif()
  if(TALUS_ALL_GPUS)
    set(CMAKE_CUDA_ARCHITECTURES ${TALUS_SUPPORTED_GPUS})
  endif()
  if(CMAKE_CUDA_ARCHITECTURES)
    set(_kernels_for ${CMAKE_CUDA_ARCHITECTURES})
  elseif(DEFINED ENV{CUDAARCHS})   # which CMake reads by itself
    set(_kernels_for $ENV{CUDAARCHS})
  elseif(TALUS_CUDA STREQUAL "ON")
    set(_kernels_for ${TALUS_SUPPORTED_GPUS})
    set(CMAKE_CUDA_ARCHITECTURES ${TALUS_SUPPORTED_GPUS})
  elseif(EXISTS /dev/nvidia0)
    set(_kernels_for native)
    set(CMAKE_CUDA_ARCHITECTURES native)
  endif()
  if(NOT _kernels_for STREQUAL "none")
    check_language(CUDA)
    if(CMAKE_CUDA_COMPILER)
      enable_language(CUDA)
      set(TALUS_WITH_CUDA ON)
    elseif(TALUS_CUDA STREQUAL "ON")
      message(FATAL_ERROR
        "TALUS_CUDA=ON, but no CUDA compiler was found. Install the CUDA Toolkit or set CMAKE_CUDA_COMPILER.")
    endif()
  endif()
endif()

# One line that says for which GPUs; `make` shows it.
string(REPLACE ";" "," _kernels_for "${_kernels_for}")
if(TALUS_WITH_CUDA)
  set(_kernels_line "GPU kernels: for ${_kernels_for} (other GPUs: make CUDAARCHS=80-real\\;90 ...)")
elseif(TALUS_CUDA STREQUAL "OFF")
  set(_kernels_line "GPU kernels: none, as asked")
elseif(NOT _kernels_for STREQUAL "none")
  set(_kernels_line "GPU kernels: none, since no CUDA Toolkit was found (install it, or set CMAKE_CUDA_COMPILER)")
else()
  set(_kernels_line
    "GPU kernels: none, since this machine has no GPU (to compile them all the same: make CUDAARCHS=90-real ...)")
endif()
message(STATUS "${_kernels_line}")
file(WRITE ${CMAKE_BINARY_DIR}/kernels.txt "${_kernels_line}\n")

if(TALUS_WITH_CUDA)
  # CMake 3.25 does not know C++20 for nvcc; without these two it refuses CUDA at C++20.
  if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
    set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
  endif()
  set(CMAKE_CUDA_STANDARD 20)
  set(CMAKE_CUDA_STANDARD_REQUIRED ON)
  set(CMAKE_CUDA_EXTENSIONS OFF)
  # Where 3.25 is the least version, the module of CMake 3.25 sets a property of nvToolsExt, which CUDA 13 has no more.
  set(_least ${CMAKE_MINIMUM_REQUIRED_VERSION})
  set(CMAKE_MINIMUM_REQUIRED_VERSION 3.24)
  find_package(CUDAToolkit REQUIRED)
  set(CMAKE_MINIMUM_REQUIRED_VERSION ${_least})
endif()

# talus_kernels(TARGET FILE...): add kernel files to a library.
function(talus_kernels target)
  foreach(file IN LISTS ARGN)
    if(TALUS_WITH_CUDA)
      set_source_files_properties(${file} PROPERTIES LANGUAGE CUDA)
    else()
      set_source_files_properties(${file} PROPERTIES LANGUAGE CXX)
    endif()
  endforeach()
  target_sources(${target} PRIVATE ${ARGN})
  if(TALUS_WITH_CUDA)
    target_compile_definitions(${target} PUBLIC TALUS_WITH_CUDA=1)
    # Host-only calls in device code are mere warnings by default, hence -Werror all-warnings.
    # -Xcompiler ",": g++'s own optimiser must see the host half of a kernel as it would see a .cpp. nvcc makes errors
    # of g++'s warnings as well, so that conversions are looked for where warnings are errors anyway.
    set(_of_nvcc --expt-relaxed-constexpr --extended-lambda -Werror all-warnings -Xcompiler=-Wall,-Wextra)
    if(TALUS_WERROR)
      list(APPEND _of_nvcc -Xcompiler=-Wconversion,-Wsign-conversion)
    endif()
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CUDA>:${_of_nvcc}>)
    target_link_libraries(${target} PUBLIC CUDA::cudart_static)
  endif()
endfunction()
