// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the points of an element: the tiles of the GPU against those of the CPU.
#include "solver/elements/element_sums.hpp"

#include "tests/solver/linear_bench.hpp"

namespace talus::solver::testing {
namespace {

/// Keeps the blocks it is handed.
template <int nodes>
struct Keep {
  double* blocks;
  void put(int e, int a, int b, const double* block) const {
    const int of_element = (a * nodes + b) * 9, each = nodes * nodes * 9;
    std::copy(block, block + 9, blocks + static_cast<std::size_t>(e) * each + of_element);
  }
};

template <class Shape>
void check_tiles() {
  constexpr int w = Shape::width, nodes = w * w * w;
  LinearBench<double, CpuDevice, Shape> bench({kind_of<Shape>});
  ElementList<double, CpuDevice, Shape> list(bench.device);
  list.build(bench.grid.view(), bench.points.view());
  const auto size = static_cast<std::size_t>(list.count()) * nodes * nodes * 9;
  std::vector<double> whole(size), slices(size);
  sum_elements<double, CpuDevice, Shape>(list, bench.from(), Keep<nodes>{whole.data()});
  using Slice = SumElements<double, Shape, 1, w * w, Keep<nodes>>;
  const Slice slice{bench.from(), list.view(), {slices.data()}};
  for (int i = 0; i < list.count() * Slice::tiles; ++i) slice(i);
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < size; ++i) {
    worst = std::max(worst, std::abs(whole[i] - slices[i]));
    largest = std::max(largest, std::abs(whole[i]));
  }
  EXPECT_LT(worst, 1e-13 * largest);
}

TEST(Elements, are_the_same_from_the_tiles_of_the_gpu) {
  check_tiles<Linear>();
  check_tiles<Quadratic>();
  check_tiles<Gimp>();
}

}  // namespace
}  // namespace talus::solver::testing
