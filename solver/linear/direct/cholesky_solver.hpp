// The reference paper's case 1: the tangent assembled and factorised. Between steps: begin_step(); for each Newton
// iteration: solve().
#pragma once

#include "solver/linear/direct/cholesky.hpp"
#include "solver/linear/direct/csr_assembly.hpp"
#include "solver/linear/krylov/linear_report.hpp"

namespace talus::solver {

template <class Real, class Device, class Shape>
class CholeskySolver {
 public:
  /// `memory_limit` [bytes] stands for what is free on the device; 0: ask.
  explicit CholeskySolver(const Device& device, double memory_limit = 0)
      : device_(device), limit_(memory_limit), cholesky_(make_cholesky(device, memory_limit)) {}
  explicit CholeskySolver(double memory_limit = 0) : CholeskySolver(Device{}, memory_limit) {}

  /// The points have moved, or have been sorted, and `list` is their elements anew; it must stay until the next call.
  void begin_step(const ElementList<Real, Device, Shape>& list) { list_ = &list; }

  /// Solves freed (K + mass inertia + stiffness) freed x = freed b; x is 0 on held nodes. One iteration, residual |b -
  /// A x| / |b|; `indefinite` when the matrix is not positive definite to working precision, and x is then 0. Throws
  /// NumericalError, before it allocates, when the matrix or its factor would not fit.
  LinearReport solve(const PointTangents<Real>& from, const HeldNodes& nodes, const NodeVector<Device>& b,
                     NodeVector<Device>& x);

  const Cholesky<Device>& factor() const { return *cholesky_; }
  const CsrAssembly<Real, Device, Shape>& assembly() const { return assembly_; }
  /// Matrix, triples and element matrices; the factor's own are factor().factor_bytes().
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
