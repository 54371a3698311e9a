// Sparse Cholesky factorisation: CHOLMOD on the CPU (Chen, Davis, Hager & Rajamanickam 2008; Eigen's where it was not
// found), cuSOLVER on the GPU. Ordering and symbolic factor are kept while the matrix keeps its pattern.
#pragma once

#include <memory>
#include <string>

#include "solver/linear/direct/csr_matrix.hpp"

namespace talus {

/// Ends with a NumericalError that states the size, the limit and the way out.
[[noreturn]] void refuse_matrix(const std::string& what, double bytes, double limit, bool gpu);

template <class Device>
class Cholesky {
 public:
  virtual ~Cholesky() = default;

  /// Solves A x = b. False when A is not positive definite; x is then undefined. Throws NumericalError when the factor
  /// would not fit, before it is made, and when a GPU has no cuSOLVER.
  virtual bool solve(const CsrMatrix<Device>& a, const Buffer<double, Device>& b, Buffer<double, Device>& x) = 0;

  virtual int analyses() const = 0;         // orderings and symbolic factorisations so far
  virtual double factor_bytes() const = 0;  // of the present factor
  virtual const char* name() const = 0;     // of the library
};

/// The factor may take `memory_limit` bytes; 0: what is free where it will stand.
std::unique_ptr<Cholesky<CpuDevice>> make_cholesky(const CpuDevice& device, double memory_limit = 0);
std::unique_ptr<Cholesky<GpuDevice>> make_cholesky(const GpuDevice& device, double memory_limit = 0);

}  // namespace talus
