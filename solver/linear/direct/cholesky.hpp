// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sparse Cholesky factorisation: CHOLMOD on the CPU (Chen, Davis, Hager & Rajamanickam 2008; Eigen's where it was not
// found), cuSOLVER on the GPU. Ordering and symbolic factor are kept while the matrix keeps its pattern.
#pragma once

#include <memory>
#include <string>

#include "solver/linear/direct/csr_matrix.hpp"

namespace talus {

/// This function ends with a NumericalError that states the size of the matrix, the limit and the way out.
[[noreturn]] void refuse_matrix(const std::string& what, double bytes, double limit, bool gpu);

/// A sparse Cholesky solver that keeps ordering and symbolic factor while the matrix keeps its pattern. `Device` is
/// where the matrix lies: CHOLMOD or Eigen solves on the CPU, cuSOLVER on the GPU.
template <class Device>
class Cholesky {
 public:
  virtual ~Cholesky() = default;

  /// The method solves A x = b, x and b [a.rows]. It returns false when A is not positive definite; x is then
  /// undefined. It throws NumericalError when the factor would not fit, before it is made, and when a GPU has no
  /// cuSOLVER.
  virtual bool solve(const CsrMatrix<Device>& a, const Buffer<double, Device>& b, Buffer<double, Device>& x) = 0;

  virtual int analyses() const = 0;         ///< number of orderings and symbolic factorisations so far
  virtual double factor_bytes() const = 0;  ///< size of the present factor [bytes]
  virtual const char* name() const = 0;     ///< name of the library that factorises
};

/// The solver for matrices on the CPU. The factor may take `memory_limit` bytes; 0: what is free where it will lie.
std::unique_ptr<Cholesky<CpuDevice>> make_cholesky(const CpuDevice& device, double memory_limit = 0);
/// The solver for matrices on the GPU, with the same limit. It throws NumericalError where there is no cuSOLVER.
std::unique_ptr<Cholesky<GpuDevice>> make_cholesky(const GpuDevice& device, double memory_limit = 0);

}  // namespace talus
