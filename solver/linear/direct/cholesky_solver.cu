#include "solver/linear/direct/cholesky_solver.hpp"

#include <cmath>

#include "solver/grid/instances.hpp"
#include "solver/parallel/profile.hpp"

namespace talus::solver {

template <class Real, class Place, class Shape>
void CholeskySolver<Real, Place, Shape>::check_memory(int nodes) const {
  const double wanted = assembly_bytes<Real, Shape>(list_->count(), nodes);
  const double free = limit_ > 0 ? limit_ : free_memory(Place{}) + static_cast<double>(bytes());
  if (wanted > free || !assembly_countable<Real, Shape>(list_->count(), nodes))
    refuse_matrix("the triples and the matrix would take", wanted, free, Place::is_gpu);
}

template <class Real, class Place, class Shape>
LinearReport CholeskySolver<Real, Place, Shape>::solve(const PointTangents<Real>& from, const HeldNodes& nodes,
                                                       const NodeVector<Place>& b, NodeVector<Place>& x) {
  const int unknowns = assembly_.number_nodes(nodes);
  LinearReport report;
  x.resize(static_cast<std::size_t>(nodes.count));
  x.fill_zero();
  if (unknowns == 0) {
    report.converged = true;
    return report;
  }
  check_memory(unknowns);
  {
    const ProfilePhase<Place> phase("element matrices");
    stored_.assemble(*list_, from);
  }
  {
    const ProfilePhase<Place> phase("sort and reduce to rows");
    assembly_.assemble(*list_, stored_, nodes);
    assembly_.to_unknowns(nodes, b, right_);
  }
  const CsrMatrix<Place>& a = assembly_.matrix();
  report.iterations = 1;
  {
    const ProfilePhase<Place> phase("factorise and solve");
    if (!cholesky_->solve(a, right_, solution_)) {
      report.indefinite = true;
      return report;
    }
  }
  left_over_.resize(right_.size());
  for_each(Place{}, a.rows,
           detail::CsrResidual{a.starts.data(), a.columns.data(), a.values.data(), right_.data(), solution_.data(),
                               left_over_.data()});
  const double size = inner_product(Place{}, right_.data(), right_.data(), a.rows);
  const double left = inner_product(Place{}, left_over_.data(), left_over_.data(), a.rows);
  report.residual = size > 0 ? std::sqrt(left / size) : 0;
  // A singular matrix may pass as positive definite by rounding; its factor has no correct digits.
  report.converged = std::isfinite(left) && report.residual < 1e-6;
  report.indefinite = !report.converged;
  if (report.converged) assembly_.to_nodes(nodes, solution_, x);
  return report;
}

template <class Real, class Place, class Shape>
std::size_t CholeskySolver<Real, Place, Shape>::bytes() const {
  return stored_.bytes() + assembly_.bytes() + right_.bytes() + solution_.bytes() + left_over_.bytes();
}

#define TALUS_INSTANTIATE(Real, Place, Shape) template class CholeskySolver<Real, Place, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)

}  // namespace talus::solver
