// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points as kernels see them: the law of contact, and which mass a surface is before.
#include "solver/boundary/contact_view.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace talus::solver::testing {
namespace {

using View = ContactView<double>;

TEST(ContactLaw, gives_what_is_required_where_it_pushes_and_does_not_slip) {
  const Vec3<double> required{3, 0, 10};
  const Vec3<double> given = View::hold(required, {0, 0, 1}, 0.5);
  EXPECT_EQ(given.x, 3);
  EXPECT_EQ(given.y, 0);
  EXPECT_EQ(given.z, 10);
}

TEST(ContactLaw, does_not_pull) {
  EXPECT_EQ(length(View::hold({3, 0, -1}, {0, 0, 1}, 0.5)), 0);
  EXPECT_EQ(length(View::hold({3, 0, 0}, {0, 0, 1}, 0.5)), 0);
}

TEST(ContactLaw, holds_slip_back_up_to_the_coefficient_times_the_push) {
  const Vec3<double> normal{0.6, 0, 0.8};
  const Vec3<double> given = View::hold(normal * 10 + Vec3<double>{0, 12, 0}, normal, 0.5);
  EXPECT_NEAR(dot(given, normal), 10, 1e-14);
  EXPECT_NEAR(length(given - normal * dot(given, normal)), 0.5 * 10, 1e-14);
  EXPECT_NEAR(given.y, 5, 1e-14);
}

/// The masses of the nodes of a block of 4 x 4 columns and four layers [kg].
struct Masses {
  std::vector<double> of = std::vector<double>(4 * block_columns);
  double mass(int n) const { return of[static_cast<std::size_t>(n)]; }
};

/// A contact point a quarter of a cell behind node (1, 1, 1), on a Cartesian grid with nodes of 1 kg from i = 2 on.
struct OnePoint {
  int cell[3] = {1, 1, 1}, body = 0;
  double offset[3] = {0.25, 0, 0}, inverse_mass = 0, friction = 0.3, area = 1;
  Vec3<double> normal{1, 0, 0};
  BlockSlot slot{0, 0, 4};
  GridView<double> grid;
  Masses nodes;

  OnePoint() {
    grid.columns = grid.rows = 4;
    grid.block_columns_x = 1;
    grid.spacing = grid.layer_height = 2;
    grid.mapping = Mapping::cartesian;
    grid.slots = &slot;
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 2; i < 4; ++i) nodes.of[static_cast<std::size_t>(GridView<double>::node(slot, i, j, k))] = 1;
      }
    }
  }
  View view() {
    View v{};
    for (int a = 0; a < 3; ++a) {
      v.places.cell[a] = &cell[a];
      v.places.offset[a] = &offset[a];
    }
    v.normal = &normal;
    v.area = &area;
    v.body = &body;
    v.body_friction = &friction;
    v.inverse_mass = &inverse_mass;
    return v;
  }
};

TEST(ContactView, counts_the_mass_on_the_side_that_the_surface_looks_to) {
  OnePoint p;
  EXPECT_DOUBLE_EQ(p.view().mass_before<Linear>(p.grid, p.nodes, 0), 0.25);
  p.normal = {-1, 0, 0};
  EXPECT_EQ(p.view().mass_before<Linear>(p.grid, p.nodes, 0), 0) << "the mass is on the other side";
}

TEST(ContactView, shares_add_up_to_one_over_the_nodes_with_mass) {
  OnePoint p;
  p.inverse_mass = 1 / p.view().mass_before<Linear>(p.grid, p.nodes, 0);
  double sum = 0;
  p.view().around<Linear>(p.grid, p.nodes, 0, [&](int n, double share) {
    EXPECT_EQ(p.nodes.mass(n), 1);
    sum += share;
  });
  EXPECT_DOUBLE_EQ(sum, 1);
}

TEST(ContactView, an_obstacle_resists_with_its_own_friction) {
  OnePoint p;
  EXPECT_EQ(p.view().friction(0), 0.3);
}

TEST(ContactView, the_bed_is_covered_as_far_as_the_mass_makes_up_half_a_layer) {
  OnePoint p;
  p.inverse_mass = 1.0 / 3;
  EXPECT_DOUBLE_EQ(p.view().filled(p.grid, 0, 3), 0.5);  // 3 kg of 0.5 * 3 kg/m2 * 4 m2
  EXPECT_EQ(p.view().filled(p.grid, 0, 1), 1);
}

}  // namespace
}  // namespace talus::solver::testing
