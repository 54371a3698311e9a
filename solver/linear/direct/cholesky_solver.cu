// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/direct/cholesky_solver.hpp"

#include <cmath>

#include "solver/grid/instances.hpp"

namespace talus::solver {

template <class Real, class Device, class Shape>
void CholeskySolver<Real, Device, Shape>::check_memory(int nodes) const {
  const double needed = assembly_bytes<Real, Shape>(list_->count(), nodes);
  const double free = limit_ > 0 ? limit_ : free_memory(device_) + static_cast<double>(bytes());
  if (needed > free || !assembly_countable<Real, Shape>(list_->count(), nodes))
    refuse_matrix("the triples and the matrix would take", needed, free, Device::is_gpu);
}

template <class Real, class Device, class Shape>
LinearReport CholeskySolver<Real, Device, Shape>::solve(const PointTangents<Real>& from, const HeldNodes& nodes,
                                                        const NodeVector<Device>& b, NodeVector<Device>& x) {
  const int unknowns = assembly_.number_nodes(nodes);
  LinearReport report;
  x.resize_zeroed(static_cast<std::size_t>(nodes.count));
  if (unknowns == 0) {
    report.converged = true;
    return report;
  }
  check_memory(unknowns);
  {
    const ProfilePhase<Device> phase(device_, "element matrices");
    stored_.assemble(*list_, from);
  }
  {
    const ProfilePhase<Device> phase(device_, "sort and reduce to rows");
    assembly_.assemble(*list_, stored_, nodes);
    assembly_.to_unknowns(nodes, b, right_);
  }
  const CsrMatrix<Device>& a = assembly_.matrix();
  report.iterations = 1;
  {
    const ProfilePhase<Device> phase(device_, "factorise and solve");
    if (!cholesky_->solve(a, right_, solution_)) {
      report.indefinite = true;
      return report;
    }
  }
  left_over_.resize(right_.size());
  for_each(device_, a.rows,
           detail::CsrResidual{a.starts.data(), a.columns.data(), a.values.data(), right_.data(), solution_.data(),
                               left_over_.data()});
  const double size = inner_product(device_, right_.data(), right_.data(), a.rows);
  const double left = inner_product(device_, left_over_.data(), left_over_.data(), a.rows);
  report.residual = size > 0 ? std::sqrt(left / size) : 0;
  // A singular matrix may pass as positive definite by rounding; its factor has no correct digits.
  report.converged = std::isfinite(left) && report.residual < 1e-6;
  report.indefinite = !report.converged;
  if (report.converged) assembly_.to_nodes(nodes, solution_, x);
  return report;
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class CholeskySolver<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
