// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Dense element matrices (Bathe 1996, section 4.2), from which the matrix to factorise is assembled.
#pragma once

#include "solver/elements/element_sums.hpp"
#include "solver/parallel/vectors.hpp"

namespace talus::solver {

/// The element matrices as kernels see them: 3 W^3 rows and columns each. They lie row by row on the CPU, and entry by
/// entry on the GPU, so that the threads of neighbouring rows read neighbouring numbers.
template <class Real, class Device, class Shape>
struct ElementMatrices {
  static constexpr int nodes = Shape::width * Shape::width * Shape::width;
  static constexpr int size = 3 * nodes;
  Real* data = nullptr;
  std::size_t rows = 0;  ///< of all elements

  /// The place of an entry of element e, row and column in [0, size).
  TALUS_HD std::size_t at(int e, int row, int column) const {
    const std::size_t r = static_cast<std::size_t>(e) * size + static_cast<std::size_t>(row);
    if constexpr (Device::is_gpu) return static_cast<std::size_t>(column) * rows + r;
    return r * size + static_cast<std::size_t>(column);
  }
  /// The method writes the 3 x 3 block of local nodes (a, b) of element e, given row by row.
  TALUS_HD void put(int e, int a, int b, const Real* block) const {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) data[at(e, 3 * a + i, 3 * b + j)] = block[3 * i + j];
    }
  }
};

/// The matrices of all elements with their storage.
template <class Real, class Device, class Shape>
class StoredElements {
 public:
  using Matrices = ElementMatrices<Real, Device, Shape>;

  explicit StoredElements(const Device& device) : values_(device) {}

  /// The method sums the points' tangents into the elements' matrices.
  void assemble(const ElementList<Real, Device, Shape>& list, const PointTangents<Real>& from);

  /// The matrices as kernels see them, until the next assemble().
  Matrices view() { return {values_.data(), rows_}; }
  /// The size of the matrices [bytes].
  std::size_t bytes() const { return values_.bytes(); }

 private:
  Buffer<Real, Device> values_;
  std::size_t rows_ = 0;
};

}  // namespace talus::solver
