// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points and nodes of elements: displacement gradients, filler springs (T17a), diagonals (T19).
#include "solver/elements/forces.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/elements/filler_springs.hpp"
#include "solver/elements/point_tangents.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

template <class Shape>
class DisplacementGradients : public ::testing::Test {};
using Shapes = ::testing::Types<Linear, Quadratic, Gimp>;
TYPED_TEST_SUITE(DisplacementGradients, Shapes);

TYPED_TEST(DisplacementGradients, are_the_matrix_of_a_linear_motion) {
  const SmallGrid grid(0.3, -0.2);
  const Mat3<double> motion{{0.1, -0.2, 0.3}, {0.05, 0.4, -0.1}, {0.2, 0.15, -0.3}};
  const auto u = grid.sample([&](const Vec3<double>& at) { return motion * at + Vec3<double>{7, 8, 9}; });
  for (OnePoint& point : some_points()) {
    const PointGradients<double, TypeParam> g(grid.view(), point.view(), 0);
    const Mat3<double> gradient = displacement_gradient(grid.view(), g, u.data());
    constexpr double rounding = 1e-12;  // of 27 terms, each up to 50, over half a metre
    for (const Vec3<double>& axis : {Vec3<double>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
      const Vec3<double> off = gradient * axis - motion * axis;
      EXPECT_NEAR(length(off), 0, rounding);
    }
  }
}

TEST(StateOf, a_point_has_its_dilation_only_where_the_material_dilates) {
  OnePoint point;
  point.elastic[4] = 0.02;
  point.log_volume = -0.01;
  double dilation = 0.005;
  ParticleView<double> view = point.view();
  view.plastic_log_volume = &dilation;
  EXPECT_EQ(state_of(view, 0, true).plastic_log_volume, 0.005);
  EXPECT_EQ(state_of(view, 0, false).plastic_log_volume, 0);
  EXPECT_EQ(state_of(view, 0, false).log_volume, -0.01);
  EXPECT_EQ(state_of(view, 0, false).elastic.yz, 0.02);
}

/// An element of quadratic functions whose nodes grow heavier along x.
struct QuadraticElement {
  std::vector<int> nodes = std::vector<int>(27);
  std::vector<double> mass = std::vector<double>(27);
  QuadraticElement() {
    std::iota(nodes.begin(), nodes.end(), 0);
    for (int n = 0; n < 27; ++n) mass[static_cast<std::size_t>(n)] = n / 3 % 3 == 0 ? 0.01 : n / 3 % 3;
  }
  FillerSprings springs() const { return {.mass = mass.data(), .light = 0.1, .stiffness = 100}; }
};

TEST(FillerSprings, hold_light_nodes_to_a_line_inwards) {
  const QuadraticElement e;
  const FillerSpring s = e.springs().at<3>(e.nodes.data(), 1);  // on the light side
  EXPECT_DOUBLE_EQ(s.k, 100 * (1 - 0.01 / 0.1));
  EXPECT_EQ(s.node, 1);
  EXPECT_EQ(s.near, 4);
  EXPECT_EQ(s.far, 7);
  EXPECT_EQ(s.lead, 1);
}

TEST(FillerSprings, feel_no_affine_motion) {
  const QuadraticElement e;
  const FillerSpring s = e.springs().at<3>(e.nodes.data(), 0);
  ASSERT_GT(s.k, 0);
  double constant = 0, linear = 0;
  for (int a = 0; a < 3; ++a) {
    constant += s.share(a);
    linear += s.share(a) * (s.local(a) / 3 % 3);
  }
  EXPECT_EQ(constant, 0);
  EXPECT_EQ(linear, 0);
}

TEST(FillerSprings, leave_full_and_empty_nodes_alone) {
  QuadraticElement e;
  EXPECT_EQ(e.springs().at<3>(e.nodes.data(), 4).k, 0);
  e.mass[0] = 0;
  EXPECT_EQ(e.springs().at<3>(e.nodes.data(), 0).k, 0);
  EXPECT_FALSE(FillerSprings{}.on());
}

TEST(FillerSprings, hold_hats_to_the_fullest_node_more_weakly) {
  const std::vector<int> nodes{0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<double> mass{0.05, 1, 1, 1, 1, 3, 1, 1};
  const FillerSprings springs{.mass = mass.data(), .light = 0.1, .stiffness = 100};
  const FillerSpring s = springs.at<2>(nodes.data(), 0);
  EXPECT_DOUBLE_EQ(s.k, 0.5);
  EXPECT_EQ(s.near, 5);
  EXPECT_EQ(s.share(0) + s.share(1), 0);
  EXPECT_EQ(s.share(2), 0);
}

struct OneHeldNode {
  double mass = 2;
  Sym3<double> freed{1, 1, 1, 0, 0, 0}, stiffness{1, 2, 3, 0.5, 0, 0}, tangent{10, 20, 30, 1, 2, 3};
  HeldNodes view() const { return {.count = 1, .mass = &mass, .freed = &freed, .inertia = 5, .stiffness = &stiffness}; }
};

TEST(HeldNodes, add_mass_and_stiffness_to_the_tangent) {
  const OneHeldNode n;
  const Sym3<double> own = own_block(n.view(), n.tangent, 0);
  EXPECT_EQ(own.xx, 10 + 10 + 1);
  EXPECT_EQ(own.zz, 30 + 10 + 3);
  EXPECT_EQ(own.xy, 1.5);
  const Sym3<double> free = held_block(n.view(), n.tangent, 0);
  EXPECT_EQ(free.xx, own.xx);
  EXPECT_EQ(free.xz, own.xz);
}

TEST(HeldNodes, are_the_identity_where_they_are_held) {
  OneHeldNode n;
  n.freed = {};
  const Sym3<double> held = held_block(n.view(), n.tangent, 0);
  EXPECT_EQ(held.xx, 1);
  EXPECT_EQ(held.yy, 1);
  EXPECT_EQ(held.xy, 0);
}

TEST(HeldNodes, project_the_block_on_free_directions) {
  OneHeldNode n;
  n.freed = {0.36, 0.64, 1, 0.48, 0, 0};  // all but (0.8, -0.6, 0)
  const Sym3<double> held = held_block(n.view(), n.tangent, 0);
  const Vec3<double> fixed{0.8, -0.6, 0}, free{0.6, 0.8, 0};
  EXPECT_NEAR(dot(fixed, held * fixed), 1, 1e-14);
  EXPECT_NEAR(dot(free, held * fixed), 0, 1e-14);
  EXPECT_NEAR(dot(free, held * free), dot(free, own_block(n.view(), n.tangent, 0) * free), 1e-12);
}

}  // namespace
}  // namespace talus::solver::testing
