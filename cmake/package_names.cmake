# SPDX-FileCopyrightText: The Talus authors
# SPDX-License-Identifier: GPL-3.0-or-later
# The Debian packages by name, with what they say of one another. A build with kernels for GPUs makes talus-gpu instead
# of talus: the same programs with more in them, so that one takes the place of the other.
# Shown without a build: cmake -DTALUS_WITH_CUDA=ON -P cmake/package_names.cmake
if(TALUS_WITH_CUDA)
  set(TALUS_PACKAGE talus-gpu)
  set(TALUS_PACKAGE_OTHER talus)
  set(TALUS_PACKAGE_PROVIDES "talus (= ${PROJECT_VERSION})")
  set(TALUS_PACKAGE_KERNELS "This package runs on the CPU and on NVIDIA GPUs from Ampere on; those need
NVIDIA's driver, and nothing else of CUDA.")
  set(TALUS_PACKAGE_SUGGESTS_MORE ", libcuda1")
else()
  set(TALUS_PACKAGE talus)
  set(TALUS_PACKAGE_OTHER talus-gpu)
  set(TALUS_PACKAGE_PROVIDES "")
  set(TALUS_PACKAGE_KERNELS "This package runs on the CPU; talus-gpu runs on NVIDIA GPUs as well.")
  set(TALUS_PACKAGE_SUGGESTS_MORE "")
endif()
if(CMAKE_SCRIPT_MODE_FILE)
  message(STATUS
    "Package: ${TALUS_PACKAGE}, conflicts with ${TALUS_PACKAGE_OTHER}, provides: ${TALUS_PACKAGE_PROVIDES}")
endif()
