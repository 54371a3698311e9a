// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The reference paper's case 1: the tangent assembled and factorised. Between steps: begin_step(); for each Newton
// iteration: solve(). It is factorised by CHOLMOD on the CPU (Chen, Davis, Hager & Rajamanickam 2008; Eigen's where
// that was not found), by cuSOLVER on the GPU.
#pragma once

#include <memory>
#include <string>

#include "solver/linear/direct/csr_assembly.hpp"
#include "solver/linear/krylov/conjugate_gradient.hpp"

namespace talus {

/// This function ends with a NumericalError that states the size of the matrix, the limit and the way out.
[[noreturn]] void refuse_matrix(const std::string& what, double bytes, double limit, bool gpu);

/// A sparse Cholesky solver that keeps ordering and symbolic factor while the matrix keeps its pattern. `Device` is
/// where the matrix lies: CHOLMOD or Eigen solves on the CPU, cuSOLVER on the GPU.
template <class Device>
class Cholesky {
 public:
  virtual ~Cholesky() = default;

  /// Solves A x = b, x and b [a.rows]. It returns false when A is not positive definite; x is then undefined. It throws
  /// NumericalError when the factor would not fit, before it is made, and when a GPU has no cuSOLVER.
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

namespace talus::solver {

/// The direct solver of the tangent system (T19): it assembles, factorises and solves, in double precision. `Real` is
/// the precision of the element matrices, `Shape` the kind of shape functions.
template <class Real, class Device, class Shape>
class CholeskySolver {
 public:
  /// With a `memory_limit` [bytes] matrix and factor may take that much; with 0, what is free on the device.
  explicit CholeskySolver(const Device& device, double memory_limit = 0)
      : device_(device), limit_(memory_limit), cholesky_(make_cholesky(device, memory_limit)) {}

  /// The method takes the elements of points that have moved or have been sorted. `list` must stay until the next call.
  void begin_step(const ElementList<Real, Device, Shape>& list) { list_ = &list; }

  /// Solves freed (K + mass inertia + stiffness) freed x = freed b, x and b [nodes]; x is 0 on held nodes. Reports one
  /// iteration with the residual |b - A x| / |b|, or `indefinite` when the matrix is not positive definite to working
  /// precision; x is then 0. Throws NumericalError, before it allocates, when the matrix or its factor would not fit.
  LinearReport solve(const PointTangents<Real>& from, const HeldNodes& nodes, const NodeVector<Device>& b,
                     NodeVector<Device>& x);

  const Cholesky<Device>& factor() const { return *cholesky_; }  ///< factorisation, for its counts and its size
  const CsrAssembly<Real, Device, Shape>& assembly() const { return assembly_; }
  /// The size of matrix, triples and element matrices [bytes]; that of the factor is factor().factor_bytes().
  std::size_t bytes() const { return bytes_of(stored_, assembly_, right_, solution_, left_over_); }

 private:
  void check_memory(int nodes) const;

  Device device_;
  double limit_;
  const ElementList<Real, Device, Shape>* list_ = nullptr;
  StoredElements<Real, Device, Shape> stored_{device_};
  CsrAssembly<Real, Device, Shape> assembly_{device_};
  std::unique_ptr<Cholesky<Device>> cholesky_;
  Buffer<double, Device> right_{device_}, solution_{device_}, left_over_{device_};
};

}  // namespace talus::solver
