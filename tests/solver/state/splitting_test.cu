// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points that are drawn out beyond a cell are halved: what the halves keep, when it is done and when not.
#include <algorithm>
#include <random>
#include <set>

#include "solver/state/particles.hpp"
#include "solver/state/sides.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus {
namespace {

constexpr int side = 12;                        // cells along the grid's sides
constexpr double h = 2, h_z = 0.5, rise = 0.3;  // cell, layer [m], slope along x

/// A tilted grid of which the last column is closed.
template <class Real, class Device>
struct TiltedGrid {
  Buffer<Real, Device> slope_x, slope_y;
  Buffer<unsigned char, Device> open;

  explicit TiltedGrid(const Device& device) : slope_x(device), slope_y(device), open(device) {
    slope_x.upload(std::vector<Real>(side * side, Real(rise)));
    slope_y.upload(std::vector<Real>(side * side, Real(0)));
    std::vector<unsigned char> all(side * side, 1);
    for (std::size_t j = 0; j < side; ++j) all[j * side + side - 1] = 0;
    open.upload(all);
  }
  GridView<Real> view() const {
    GridView<Real> v;
    v.columns = v.rows = side;
    v.block_columns_x = blocks_across(side);
    v.spacing = Real(h);
    v.layer_height = Real(h_z);
    v.slope_x = slope_x.data();
    v.slope_y = slope_y.data();
    v.open = open.data();
    return v;
  }
};

/// A point in the middle of cell (i, 5), half a layer up, with sides of so many cells along the ground.
ParticleState point(int i, double along_x, double along_y) {
  ParticleState s;
  s.resize(1);
  s = solver::testing::with_all_lists(s);
  s.cell[0][0] = i;
  s.cell[1][0] = 5;
  s.offset[2][0] = 0.5;
  s.volume[0] = 8;
  s.id[0] = 3;
  s.velocity[0][0] = 1;
  s.affine[0][0] = 4;  // velocity along x, per cell along x
  s.sides[0][0] = along_x * h;
  s.sides[2][0] = along_x * h * rise;
  s.sides[4][0] = along_y * h;
  return s;
}

/// The keys of the points' cells, in their order.
std::vector<std::uint64_t> keys_of(const ParticleState& s) {
  std::vector<std::uint64_t> keys;
  for (std::size_t p = 0; p < s.size(); ++p)
    keys.push_back(home_key(blocks_across(side), s.cell[0][p], s.cell[1][p], s.cell[2][p]));
  std::sort(keys.begin(), keys.end());
  return keys;
}

constexpr ParticleNeeds needs{.affine_transfer = true, .spreads = true};

class SplittingOn : public solver::testing::OnEachDevice {
 protected:
  /// What becomes of points, in either precision.
  template <class Check>
  void split(const ParticleState& state, Check&& check) {
    const auto run = [&](auto real, const auto& device) {
      using Real = decltype(real);
      using Device = std::decay_t<decltype(device)>;
      const TiltedGrid<Real, Device> grid(device);
      Particles<Real, Device> points(device, needs);
      points.upload(state);
      Buffer<std::uint64_t, Device> keys(device);
      do keys.upload(keys_of(points.download()));
      while (points.split(grid.view(), keys.data()));
      check(points.download(), points.count());
    };
    on_device([&](const auto& device) {
      run(float{}, device);
      run(double{}, device);
    });
  }
};

double place(const ParticleState& s, std::size_t axis, std::size_t p) { return s.cell[axis][p] + s.offset[axis][p]; }

TEST_P(SplittingOn, halves_a_point_along_its_longer_side_on_the_ground) {
  split(point(5, 1.6, 0.5), [](const ParticleState& s, int count) {
    ASSERT_EQ(count, 2);
    EXPECT_EQ(s.piece, (std::vector<int>{2, 3}));
    EXPECT_EQ(s.id, (std::vector<int>{3, 3}));
    for (std::size_t p = 0; p < 2; ++p) {
      const double way = p == 0 ? 0.4 : -0.4;
      EXPECT_EQ(s.volume[p], 4);
      EXPECT_NEAR(place(s, 0, p), 5 + way, 1e-6);
      EXPECT_EQ(place(s, 1, p), 5);
      EXPECT_NEAR(place(s, 2, p), 0.5, 1e-6);
      EXPECT_NEAR(s.velocity[0][p], 1 + 4 * way, 1e-6);  // of the velocity field about the point
      EXPECT_NEAR(s.sides[3][p], 0.8 * h, 1e-6);
      EXPECT_NEAR(s.sides[5][p], 0.8 * h * rise, 1e-6);
      EXPECT_NEAR(s.sides[1][p], 0.5 * h, 1e-6);
    }
  });
}

/// A side that grew in flight says nothing of where the mass is, nor does the velocity gradient so far away.
TEST_P(SplittingOn, leaves_halves_within_half_a_cell_however_long_the_side) {
  split(point(5, 40, 0.5), [](const ParticleState& s, int count) {
    ASSERT_EQ(count, smallest_parts);
    for (std::size_t p = 0; p < s.size(); ++p) {
      EXPECT_LE(std::abs(place(s, 0, p) - 5), 1 + 1e-6);  // two halvings
      EXPECT_LE(std::abs(s.velocity[0][p] - 1), 4 + 1e-5);
    }
  });
}

TEST_P(SplittingOn, leaves_what_is_no_longer_than_a_cell) {
  for (const double along : {0.5, 1.0})
    split(point(5, along, 0.5), [](const ParticleState& s, int count) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(s.piece[0], 1);
    });
}

TEST_P(SplittingOn, takes_no_shear_for_length) {
  ParticleState s = point(5, 0.5, 0.5);
  s.sides[3][0] = 6 * s.sides[0][0];  // the second side drawn along the first: the same lattice
  s.sides[5][0] = 6 * s.sides[2][0];
  split(s, [](const ParticleState&, int count) { EXPECT_EQ(count, 1); });
}

TEST_P(SplittingOn, leaves_a_spray) {
  ParticleState s = point(5, 3, 0.5);
  s.log_volume[0] = 0.8;
  split(s, [](const ParticleState&, int count) { EXPECT_EQ(count, 1); });
}

TEST_P(SplittingOn, leaves_what_lies_among_enough_points) {
  for (const int others : {7, 6}) {
    ParticleState s = point(5, 1.6, 0.5);
    const ParticleState one = point(5, 0.5, 0.5);
    for (const int column : {4, 5, 6}) {
      for (int n = 0; n < others + (column == 5 ? 0 : 1); ++n) {
        const auto add = [](const ParticleField&, int, auto& to, const auto& from) {
          if (!from.empty()) to.push_back(from[0]);
        };
        visit_particle_fields(add, s, one);
        s.cell[0].back() = column;
      }
    }
    const int before = static_cast<int>(s.size());
    split(s, [&](const ParticleState&, int count) { EXPECT_EQ(count, before + (others == 7 ? 0 : 1)); });
  }
}

TEST_P(SplittingOn, ends_with_the_smallest_parts) {
  split(point(5, 40, 0.5), [](const ParticleState& s, int count) {
    ASSERT_EQ(count, smallest_parts);
    std::set<int> parts;
    for (std::size_t p = 0; p < s.size(); ++p) {
      EXPECT_EQ(PartRange(s.piece[p]).count, 1);
      parts.insert(PartRange(s.piece[p]).first);
      EXPECT_EQ(s.volume[p], 8.0 / smallest_parts);
    }
    EXPECT_EQ(parts.size(), smallest_parts);
  });
}

TEST_P(SplittingOn, sends_no_half_out_of_the_domain) {
  split(point(side - 2, 3, 0.5), [](const ParticleState& s, int count) {
    ASSERT_EQ(count, smallest_parts);
    for (const int i : s.cell[0]) EXPECT_LE(i, side - 2);
    for (const int i : s.cell[0]) EXPECT_GE(i, 0);
  });
}

using solver::testing::place_name;
TALUS_IN_EACH_PLACE(SplittingOn);

TEST(Sides, are_reduced_to_the_shortest_of_their_lattice) {
  std::mt19937 random(1);
  std::normal_distribution<double> any;
  for (int trial = 0; trial < 1000; ++trial) {
    Sides<double> s{{any(random), any(random), any(random)}, {any(random), any(random), any(random)}};
    const auto area = [&] {
      const double a = dot(s.shorter, s.shorter), b = dot(s.longer, s.longer), c = dot(s.shorter, s.longer);
      return a * b - c * c;
    };
    const double before = area();
    s.longer = s.longer + s.shorter * 7;
    s.reduce();
    EXPECT_NEAR(area(), before, 1e-9 * (1 + before));
    EXPECT_LE(dot(s.shorter, s.shorter), dot(s.longer, s.longer) * (1 + 1e-12));
    EXPECT_LE(std::abs(dot(s.shorter, s.longer)), 0.5 * dot(s.shorter, s.shorter) * (1 + 1e-9));
  }
}

TEST(PartRanges, are_those_of_a_point_that_is_halved_again_and_again) {
  EXPECT_EQ(PartRange(1).first, 0);
  EXPECT_EQ(PartRange(1).count, smallest_parts);
  for (int piece = 1; piece < smallest_parts; ++piece) {
    const PartRange whole(piece), first(2 * piece), second(2 * piece + 1);
    EXPECT_EQ(first.first, whole.first);
    EXPECT_EQ(second.first, first.first + first.count);
    EXPECT_EQ(first.count + second.count, whole.count);
  }
}

}  // namespace
}  // namespace talus
