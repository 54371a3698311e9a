// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/direct/stored_elements.hpp"

#include "solver/grid/instances.hpp"

namespace talus::solver {
template <class Real, class Device, class Shape>
void StoredElements<Real, Device, Shape>::assemble(const ElementList<Real, Device, Shape>& list,
                                                   const PointTangents<Real>& from) {
  rows_ = static_cast<std::size_t>(list.count()) * Matrices::size;
  values_.resize(rows_ * Matrices::size);
  sum_elements<Real, Device, Shape>(list, from, view());
}

#define TALUS_INSTANTIATE(Real, Device, Shape) template class StoredElements<Real, Device, Shape>;
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
