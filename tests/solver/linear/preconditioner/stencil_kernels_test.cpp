// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels between grids: what goes to the finer one is the transpose of what goes to the coarser, (T20).
#include "solver/linear/preconditioner/stencil_kernels.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

std::vector<Vec3<double>> random_vectors(std::size_t count, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Vec3<double>> v(count);
  for (Vec3<double>& x : v) x = {u(engine), u(engine), u(engine)};
  return v;
}
double product(const std::vector<Vec3<double>>& a, const std::vector<Vec3<double>>& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += dot(a[n], b[n]);
  return sum;
}

/// A grid of which every node is a row, and a coarser one that holds all its parents.
struct TwoGrids {
  SmallGrid fine, coarse;
  std::vector<int> rows;  ///< row n is node n
  std::vector<NodePlace> places = std::vector<NodePlace>(SmallGrid::nodes);
  TwoGrids() {
    for (int n = 0; n < SmallGrid::nodes; ++n) rows.push_back(n);
    const StoredColumns<double> columns{fine.view(), fine.active.data(), 4};
    for (int c = 0; c < columns.count(); ++c) PlaceRows<double>{columns, rows.data(), places.data()}(c);
  }
};

TEST(StencilKernels, place_rows_where_their_nodes_lie) {
  const TwoGrids grids;
  for (int n = 0; n < SmallGrid::nodes; ++n) {
    const NodePlace at = grids.places[static_cast<std::size_t>(n)];
    EXPECT_EQ(grids.fine.view().find(at.i, at.j, at.k), n);
  }
}

TEST(StencilKernels, restrict_with_the_transpose_of_what_they_prolong_with) {
  const TwoGrids grids;
  for (const TwoScale x : {TwoScale{TwoScale::same}, TwoScale{TwoScale::hats}, TwoScale{TwoScale::splines}}) {
    const TwoScale y{TwoScale::hats};
    const auto fine = random_vectors(SmallGrid::nodes, 1), coarse = random_vectors(SmallGrid::nodes, 2);
    std::vector<Vec3<double>> down(SmallGrid::nodes), up(SmallGrid::nodes);
    const RestrictRows<double> restricts{
        {grids.fine.view(), x, y, grids.places.data(), grids.rows.data(), fine.data(), down.data()}};
    const ProlongRows<double> prolongs{
        {grids.coarse.view(), x, y, grids.places.data(), grids.rows.data(), coarse.data(), up.data()}};
    for (int n = 0; n < SmallGrid::nodes; ++n) {
      restricts(n);
      prolongs(n);
    }
    EXPECT_GT(product(up, up), 1);
    EXPECT_NEAR(product(down, coarse), product(fine, up), 1e-12 * SmallGrid::nodes);  // sums of that many products
  }
}

TEST(StencilKernels, hold_a_constant_exactly_on_the_finer_grid) {
  const TwoGrids grids;
  const std::vector<Vec3<double>> ones(SmallGrid::nodes, {1, 2, 3});
  std::vector<Vec3<double>> up(SmallGrid::nodes);
  const TwoScale splines{TwoScale::splines};
  for (int n = 0; n < SmallGrid::nodes; ++n)
    ProlongRows<double>{
        {grids.coarse.view(), splines, splines, grids.places.data(), grids.rows.data(), ones.data(), up.data()}}(n);
  for (const Vec3<double>& v : up) EXPECT_EQ(v.z, 3);  // weights of sixteenths
}

TEST(StencilKernels, flag_the_parents_of_every_row) {
  const TwoGrids grids;
  std::vector<int> flags(SmallGrid::nodes);
  const TwoScale hats{TwoScale::hats};
  const FlagParents<double> flag{grids.coarse.view(), hats, hats, grids.places.data(), flags.data()};
  const int n = grids.fine.view().find(5, 4, 3);
  flag(n);
  const GridView<double> coarse = grids.coarse.view();
  for (int at = 0; at < SmallGrid::nodes; ++at) {
    const bool parent = at == coarse.find(2, 2, 3) || at == coarse.find(3, 2, 3);
    EXPECT_EQ(flags[static_cast<std::size_t>(at)], parent ? 1 : 0) << "node " << at;
  }
}

}  // namespace
}  // namespace talus::solver::testing
