// The maps that an implicit step leaves of a column of nodes.
#include "solver/implicit/record_columns.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

/// A grid with mass in column (5, 2) alone, and its maps.
struct Recorded {
  SmallGrid grid;
  std::vector<double> mass = std::vector<double>(SmallGrid::nodes), thickness = std::vector<double>(64),
                      speed = thickness, pressure = thickness, arrival = std::vector<double>(64, -1);
  std::vector<Vec3<double>> velocity = std::vector<Vec3<double>>(SmallGrid::nodes);

  Recorded() {
    put(1, 1000, {3, 0, 0});
    put(4, 3000, {0, 0, -1});
  }
  void put(int k, double m, const Vec3<double>& v) {
    const auto n = static_cast<std::size_t>(grid.view().find(5, 2, k));
    mass[n] = m;
    velocity[n] = v;
  }
  void record(const Vec3<double>* moves, const double* volumes = nullptr) {
    const MapView maps{{thickness.data(), speed.data(), pressure.data(), arrival.data()}, 0.1};
    const RecordColumns<double> kernel{grid.view(), grid.active.data(), mass.data(), moves, 2000, volumes, 7, maps};
    for (int c = 0; c < 4 * block_columns; ++c) kernel(c);
  }
};

constexpr std::size_t column = 2 * SmallGrid::side + 5;

TEST(RecordColumns, keeps_the_sums_over_the_layers_of_the_column_that_has_mass) {
  Recorded r;
  r.record(r.velocity.data());
  EXPECT_DOUBLE_EQ(r.thickness[column], 4000.0 / (2000 * 4));
  const double speed = std::sqrt(2.0) * 3000 / 4000;  // momenta of 3000 east and 3000 down
  EXPECT_DOUBLE_EQ(r.speed[column], speed);
  EXPECT_DOUBLE_EQ(r.pressure[column], 2000 * speed * speed);
  EXPECT_EQ(r.arrival[column], 7);
  for (std::size_t c = 0; c < r.thickness.size(); ++c) {
    if (c == column) continue;
    EXPECT_EQ(r.thickness[c] + r.speed[c], 0) << "column " << c;
  }
}

TEST(RecordColumns, knows_no_speed_in_statics) {
  Recorded r;
  r.record(nullptr);
  EXPECT_EQ(r.speed[column], 0);
  EXPECT_DOUBLE_EQ(r.thickness[column], 0.5);
}

TEST(RecordColumns, measures_thickness_by_volume_where_densities_differ) {
  Recorded r;
  std::vector<double> volumes(64);
  volumes[column] = 4;  // 1000 kg/m3 for 4000 kg
  r.record(nullptr, volumes.data());
  EXPECT_DOUBLE_EQ(r.thickness[column], 1);
}

}  // namespace
}  // namespace talus::solver::testing
