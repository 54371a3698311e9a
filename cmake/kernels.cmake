# How a kernel file (.cu) is compiled: by nvcc where there is one, by the host compiler otherwise. Both places live in one
# binary; TALUS_WITH_CUDA says whether the second one is there.
set(TALUS_WITH_CUDA OFF)
if(NOT TALUS_CUDA STREQUAL "OFF")
  include(CheckLanguage)
  if(NOT CMAKE_CUDA_COMPILER AND EXISTS /usr/local/cuda/bin/nvcc)
    set(CMAKE_CUDA_COMPILER /usr/local/cuda/bin/nvcc)
  endif()
  if(NOT CMAKE_CUDA_ARCHITECTURES AND NOT DEFINED ENV{CUDAARCHS})   # which CMake reads by itself
    # Ampere (and, by binary compatibility, Ada) and Hopper, with PTX for what comes after.
    set(CMAKE_CUDA_ARCHITECTURES "80-real;90")
  endif()
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    enable_language(CUDA)
    set(TALUS_WITH_CUDA ON)
  elseif(TALUS_CUDA STREQUAL "ON")
    message(FATAL_ERROR "TALUS_CUDA=ON, but no CUDA compiler was found. Install the CUDA Toolkit or set CMAKE_CUDA_COMPILER.")
  endif()
endif()
message(STATUS "Talus: GPU kernels ${TALUS_WITH_CUDA}")

if(TALUS_WITH_CUDA)
  # CMake 3.25 does not know C++20 for nvcc; without these two it refuses CUDA at C++20.
  if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
    set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
  endif()
  set(CMAKE_CUDA_STANDARD 20)
  set(CMAKE_CUDA_STANDARD_REQUIRED ON)
  set(CMAKE_CUDA_EXTENSIONS OFF)
  find_package(CUDAToolkit REQUIRED)
endif()

# talus_kernels(TARGET FILE...): add kernel files to a library.
function(talus_kernels target)
  foreach(file IN LISTS ARGN)
    if(TALUS_WITH_CUDA)
      set_source_files_properties(${file} PROPERTIES LANGUAGE CUDA)
    else()
      set_source_files_properties(${file} PROPERTIES LANGUAGE CXX COMPILE_OPTIONS "-xc++")
    endif()
  endforeach()
  target_sources(${target} PRIVATE ${ARGN})
  if(TALUS_WITH_CUDA)
    target_compile_definitions(${target} PUBLIC TALUS_WITH_CUDA=1)
    # Host-only calls in device code are mere warnings by default, hence -Werror all-warnings.
    # -Xcompiler ",": g++'s own optimiser must see the host half of a kernel as it would see a .cpp.
    target_compile_options(${target} PRIVATE
      $<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr --extended-lambda -Werror all-warnings -Xcompiler=-Wall,-Wextra>)
    target_link_libraries(${target} PUBLIC CUDA::cudart_static)
  endif()
endfunction()
