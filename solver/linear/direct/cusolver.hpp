// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The part of cuSOLVER that sparse Cholesky needs, loaded when it is first used, so that the program starts on machines
// without it. All of cusolverSp is marked deprecated in CUDA 13 in favour of cuDSS, which the toolkit does not contain;
// it works.
#pragma once

#include <cstddef>
#include <cstdint>

struct CUstream_st;  // CUDA's

namespace talus {

/// The functions of cuSOLVER in use, with signatures as in cusolverSp.h, cusolverSp_LOWLEVEL_PREVIEW.h and cusparse.h
/// (CUDA 11 to 13); status 0 is success.
struct Cusolver {
  using Handle = void*;
  using Descriptor = void*;
  using Info = void*;
  static constexpr int out_of_memory = 2;  ///< CUSOLVER_STATUS_ALLOC_FAILED

  int (*create)(Handle*) = nullptr;
  int (*destroy)(Handle) = nullptr;
  int (*set_stream)(Handle, CUstream_st*) = nullptr;
  int (*create_descriptor)(Descriptor*) = nullptr;
  int (*destroy_descriptor)(Descriptor) = nullptr;
  int (*create_info)(Info*) = nullptr;
  int (*destroy_info)(Info) = nullptr;
  int (*order_by_dissection)(Handle, int n, int entries, Descriptor, const int* starts, const int* columns,
                             const std::int64_t* options, int* order) = nullptr;
  int (*order_by_degree)(Handle, int n, int entries, Descriptor, const int* starts, const int* columns,
                         int* order) = nullptr;
  int (*analyse)(Handle, int n, int entries, Descriptor, const int* starts, const int* columns, Info) = nullptr;
  int (*sizes)(Handle, int n, int entries, Descriptor, const double* values, const int* starts, const int* columns,
               Info, std::size_t* internal_bytes, std::size_t* workspace_bytes) = nullptr;
  int (*factorise)(Handle, int n, int entries, Descriptor, const double* values, const int* starts, const int* columns,
                   Info, void* workspace) = nullptr;
  int (*zero_pivot)(Handle, Info, double tolerance, int* position) = nullptr;
  int (*solve)(Handle, int n, const double* b, double* x, Info, void* workspace) = nullptr;
};

/// The library; throws NumericalError with what to install when it cannot be loaded.
const Cusolver& cusolver();

}  // namespace talus
