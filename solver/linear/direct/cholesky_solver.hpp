// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The reference paper's case 1: the tangent assembled and factorised. Between steps: begin_step(); for each Newton
// iteration: solve().
#pragma once

#include "solver/linear/direct/cholesky.hpp"
#include "solver/linear/direct/csr_assembly.hpp"
#include "solver/linear/krylov/linear_report.hpp"

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

  /// The method solves freed (K + mass inertia + stiffness) freed x = freed b, x and b [nodes]; x is 0 on held nodes.
  /// It reports one iteration with the residual |b - A x| / |b|, or `indefinite` when the matrix is not positive
  /// definite to working precision; x is then 0. It throws NumericalError, before it allocates, when the matrix or its
  /// factor would not fit.
  LinearReport solve(const PointTangents<Real>& from, const HeldNodes& nodes, const NodeVector<Device>& b,
                     NodeVector<Device>& x);

  /// The factorisation, for its counts and its size.
  const Cholesky<Device>& factor() const { return *cholesky_; }
  /// The assembly, for its counts and its size.
  const CsrAssembly<Real, Device, Shape>& assembly() const { return assembly_; }
  /// The size of matrix, triples and element matrices [bytes]; that of the factor is factor().factor_bytes().
  std::size_t bytes() const;

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
