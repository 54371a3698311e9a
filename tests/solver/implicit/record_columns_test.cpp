// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps that an implicit step leaves of a column of nodes.
#include "solver/implicit/record_columns.hpp"

#include <gtest/gtest.h>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// A grid with mass in column (5, 2) alone, and its maps.
struct Recorded {
  SmallGrid grid;
  std::vector<double> mass = std::vector<double>(SmallGrid::nodes), thickness = std::vector<double>(64),
                      speed = thickness, pressure = thickness, arrival = std::vector<double>(64, -1);

  Recorded() {
    put(1, 1000);
    put(4, 3000);
  }
  void put(int k, double m) { mass[static_cast<std::size_t>(grid.view().find(5, 2, k))] = m; }
  void record(const double* volumes = nullptr) {
    const MapView maps{{thickness.data(), speed.data(), pressure.data(), arrival.data()}, 0.1};
    const RecordColumns<double> kernel{grid.view(), grid.active.data(), mass.data(), {2000, volumes}, 7, maps};
    for (int c = 0; c < 4 * block_columns; ++c) kernel(c);
  }
};

constexpr std::size_t column = 2 * SmallGrid::side + 5;

TEST(RecordColumns, keeps_the_sum_over_the_layers_of_the_column_that_has_mass) {
  Recorded r;
  r.record();
  EXPECT_DOUBLE_EQ(r.thickness[column], 4000.0 / (2000 * 4));
  EXPECT_EQ(r.arrival[column], 7);
  for (std::size_t c = 0; c < r.thickness.size(); ++c) {
    if (c == column) continue;
    EXPECT_EQ(r.thickness[c], 0) << "column " << c;
    EXPECT_EQ(r.arrival[c], -1) << "column " << c;
  }
}

TEST(RecordColumns, measures_thickness_by_volume_where_densities_differ) {
  Recorded r;
  std::vector<double> volumes(64);
  volumes[column] = 4;  // 1000 kg/m3 for 4000 kg
  r.record(volumes.data());
  EXPECT_DOUBLE_EQ(r.thickness[column], 1);
}

}  // namespace
}  // namespace talus::solver::testing
