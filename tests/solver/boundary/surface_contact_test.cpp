// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Walls in the grid, and contact points of obstacles: on the host, on a device, as kernels see them, and in runs.
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <memory>
#include <tuple>

#include "solver/boundary/contact_points.hpp"
#include "solver/boundary/surface_contact.hpp"
#include "solver/boundary/walls.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

TEST(WallNodes, are_the_innermost_upright_walls_that_stand_still) {
  Walls<double> walls;
  const auto add = [&](int axis, double position, int side, double speed) {
    Wall<double>& w = walls.list[walls.count++];
    w.axis = axis;
    w.position = position;
    w.side = side;
    w.speed = speed;
  };
  add(0, 3, 1, 0);
  add(0, 5, 1, 0);     // inside the first
  add(0, 9.5, -1, 0);  // between nodes
  add(1, 2, 1, 0.1);   // moves
  add(1, 20, -1, 0);
  add(1, 18, -1, 0);
  add(2, 4, -1, 0);  // level
  const WallNodes nodes = wall_nodes(walls);
  EXPECT_EQ(nodes.west, 5);
  EXPECT_EQ(nodes.east, WallNodes::far);
  EXPECT_EQ(nodes.south, -WallNodes::far);
  EXPECT_EQ(nodes.north, 18);
  EXPECT_EQ(nodes.x.first, 5);
  EXPECT_EQ(nodes.x.last, 9.5);
  EXPECT_EQ(nodes.y.first, -WallNodes::far);
  EXPECT_EQ(nodes.y.last, 18);
}

constexpr WallFrame frame{{100, 200, 50}, {2, 4, 0.5}};

TEST(PlaneWalls, stand_in_cells_of_their_axis) {
  const std::vector<PlaneWall> walls{
      {.axis = 0, .side = 1, .position = 106, .kind = WallKind::fixed},
      {.axis = 1, .side = -1, .position = 240, .kind = WallKind::frictional, .friction = 0.25},
      {.axis = 2, .position = 51}};
  const Walls<double> standing = walls_at<double>(walls, 0, frame);
  ASSERT_EQ(standing.count, 3);
  EXPECT_EQ(standing.list[0].position, 3);
  EXPECT_EQ(standing.list[0].kind, WallKind::fixed);
  EXPECT_EQ(standing.list[1].position, 10);
  EXPECT_EQ(standing.list[1].side, -1);
  EXPECT_EQ(standing.list[1].friction, 0.25);
  EXPECT_EQ(standing.list[2].position, 2);
  EXPECT_EQ(walls_at<float>(walls, 0, frame).list[1].position, 10.0F);
}

TEST(PlaneWalls, move_and_go) {
  const std::vector<PlaneWall> gate{{.axis = 0, .position = 100, .speed = 3, .to = 5}};
  EXPECT_EQ(walls_at<double>(gate, 0, frame).count, 1);
  const Walls<double> moved = walls_at<double>(gate, 2, frame);
  EXPECT_EQ(moved.list[0].position, 3);  // 2 s at 3 m/s over cells of 2 m
  EXPECT_EQ(moved.list[0].speed, 3);
  EXPECT_EQ(walls_at<double>(gate, 5, frame).count, 0);
  EXPECT_EQ(walls_at<double>(gate, 5 * (1 - 1e-15), frame).count, 0) << "times a rounding apart are one";
}

constexpr int across = 5, along = 5;  ///< a node

/// Walls with this one alone.
Walls<double> one(const Wall<double>& wall) {
  Walls<double> walls;
  walls.count = 1;
  walls.list[0] = wall;
  return walls;
}

void expect(const Vec3<double>& v, double x, double y, double z) { expect_near(v, {x, y, z}, 1e-14); }

TEST(BesideWalls, have_the_velocity_that_upright_walls_leave_them) {
  const auto left = [](const Wall<double>& wall) {
    return beside_walls(one(wall), across, along, 0, Vec3<double>{1, 2, -3}, normal_of(0.0, 0.0)).left;
  };
  expect(left({.axis = 1, .side = -1, .position = 5, .speed = 0.25}), 1, 0.25, -3);
  expect(left({.axis = 1, .side = -1, .position = 5, .kind = WallKind::frictional, .friction = 0.5}), 1, 0, -3);
  expect(left({.axis = 1, .side = 1, .position = 5, .kind = WallKind::frictional}), 1, 2, -3);  // it leaves the wall
  expect(left({.axis = 0, .side = -1, .position = 5, .kind = WallKind::fixed}), 0, 0, 0);
  expect(left({.axis = 0, .side = -1, .position = 6}), 1, 2, -3);  // the wall is elsewhere
  expect(left({.axis = 2, .side = 1, .position = 1}), 1, 2, -3);   // a level one has a friction of its own
}

/// The velocity of a node after a bed of this slope along x and coefficient, and after the walls.
Vec3<double> after(const Walls<double>& walls, double slope, double coefficient, const Vec3<double>& v,
                   double leverage = 1) {
  const BaseFriction<double> friction{FrictionLaw::coulomb, {{coefficient}}};
  const BesideWalls<double> node = beside_walls(walls, across, along, 0, v, normal_of(slope, 0.0));
  const Vec3<double> met = meet_ground(friction, 0, node, slope, 0.0, {.duration = 0.01, .leverage = leverage});
  return meet_walls(walls, across, along, 0, met, true);
}

TEST(BesideWalls, rest_in_the_corner_between_a_slope_and_a_wall_at_its_foot) {
  // The slope descends towards the wall and bears 5/4 of what falls on it, its normal being (3, 0, 4) / 5.
  const Walls<double> foot = one({.axis = 0, .side = -1, .position = 5});
  expect(after(foot, -0.75, 0, {0, 0, -2}), 0, 0, 0);
  expect(after(foot, -0.75, 0, {7, 3, -2}), 0, 3, 0);
  expect(after(foot, -0.75, 0.2, {7, 3, -2}), 0, 3 - 0.2 * 1.25 * 2, 0);
  expect(after(foot, -0.75, 5, {7, 3, -2}), 0, 0, 0);
  expect(after(one({.axis = 0, .side = -1, .position = 5, .kind = WallKind::fixed}), -0.75, 0, {7, 3, -2}), 0, 0, 0);
}

TEST(BesideWalls, press_on_a_frictional_wall_by_what_the_slope_turns_towards_it) {
  const Walls<double> foot = one({.axis = 0, .side = -1, .position = 5, .kind = WallKind::frictional, .friction = 0.4});
  // The wall bears 3/4 of the fall.
  expect(after(foot, -0.75, 0, {0, 3, -2}), 0, 3 - 0.4 * 0.75 * 2, 0);
  // A bed that rises towards the wall pushes the node off: the wall does not matter.
  expect(after(foot, 0.75, 0, {0.5, 3, -2}), 0.5 - 0.6 * 1.9, 3, -2 + 0.8 * 1.9);
}

TEST(BesideWalls, are_rubbed_by_the_impulse_that_holds_them_where_inertia_differs_across_the_bed) {
  constexpr double slope = -0.75, leverage = 2.5, coefficient = 0.2;
  const Walls<double> foot = one({.axis = 0, .side = -1, .position = 5});
  // Impulses of bed and wall: the inertia across the bed, 2.5 times that along it, times (0, 0, 2).
  const Eigen::Vector2d normal(0.6, 0.8), wall(1, 0), change(0, 2);
  const Eigen::Matrix2d inertia =
      leverage * normal * normal.transpose() + (Eigen::Matrix2d::Identity() - normal * normal.transpose());
  Eigen::Matrix2d directions;
  directions << normal, wall;
  const double pressing = directions.partialPivLu().solve(inertia * change)[0];
  expect(after(foot, slope, coefficient, {0, 3, -2}, leverage), 0, 3 - coefficient * pressing, 0);
}

TEST(ContactPoints, refuse_an_obstacle_without_a_file) {
  Domain d = ground(14, 12, 2, 1.0, [](double x, double y) { return 20 + 0.3 * x - 0.2 * y; });
  fill(d, {10, 14, 8, 12, 0, 2});
  const Scene scene = make_scene(d, {});
  EXPECT_EQ(scene.contacts.size(), 0u) << "there are no points without obstacles";
  EXPECT_THROW(make_contact_points(scene.map, scene.grid, make_terrain_tables(scene.grid),
                                   {{"pier", "/no/such.vdb", "", nullptr}}),
               DataError);
}

/// A place on the map, turned about the middle by quarters, then mirrored.
struct Turn {
  int quarters;
  bool mirrored;
  std::array<double, 2> operator()(double x, double y) const {
    for (int q = 0; q < quarters; ++q) std::tie(x, y) = std::tuple(-y, x);
    return {mirrored ? -x : x, y};
  }
  std::array<double, 2> back(double x, double y) const { return Turn{(4 - quarters) % 4, false}(mirrored ? -x : x, y); }
};

/// An upright box: middle, half of its sides and height [m], and the angle that it is turned by [rad].
struct UprightBox {
  double x, y, along, across, height, angle;
  double distance(double px, double py, double pz) const {
    const double c = std::cos(angle), s = std::sin(angle), u = std::abs((px - x) * c + (py - y) * s) - along,
                 v = std::abs((py - y) * c - (px - x) * s) - across, over = std::max(pz - height, -5 - pz);
    return std::max({u, v, over});
  }
};

constexpr Corner far_corner{500000, 5000000};  // of a map of 32 x 32 cells of 2 m
constexpr double middle_x = far_corner.x + 32, middle_y = far_corner.y + 32;

/// The contact points of a box on a slope, all of it turned: places from the middle in cells, normals, areas.
ContactPoints points_of(const UprightBox& box, const Turn& turn) {
  Domain d = ground(
      32, 32, 2, 1.0,
      [&](double x, double y) {
        const auto [u, v] = turn.back(x - middle_x, y - middle_y);
        return 0.02 * u - 0.01 * v;
      },
      far_corner);
  fill(d, {far_corner.x + 10, far_corner.x + 14, far_corner.y + 8, far_corner.y + 12, 0, 2});
  const Scene scene = make_scene(d, {});
  const auto [x, y] = turn(box.x, box.y);
  const double reach = box.along + box.across;
  const SolidBody body{"box",
                       {middle_x + x - reach, middle_y + y - reach, -5},
                       {middle_x + x + reach, middle_y + y + reach, box.height},
                       [=](double px, double py, double pz) {
                         const auto [u, v] = turn.back(px - middle_x, py - middle_y);
                         return box.distance(u, v, pz);
                       }};
  return make_contact_points(scene.map, scene.grid, make_terrain_tables(scene.grid),
                             {{"box", "", "", std::make_shared<const VoxelBody>(VoxelBody{body, 0.25})}});
}

/// The largest difference of a contact point from that of the turned body [cells; the area in cells' faces].
double off_when_turned(const UprightBox& box, const Turn& turn) {
  const ContactPoints points = points_of(box, {0, false}), turned = points_of(box, turn);
  if (points.area.size() != turned.area.size()) return INFINITY;
  const auto place = [](const ContactPoints& p, std::size_t c, std::size_t axis) {
    return p.cell[axis][c] + p.offset[axis][c] - (axis < 2 ? 15.5 : 0.0);
  };
  double worst = 0;
  for (std::size_t c = 0; c < points.area.size(); ++c) {
    const auto [x, y] = turn(place(points, c, 0), place(points, c, 1));
    const auto [nx, ny] = turn(points.normal[c].x, points.normal[c].y);
    double best = INFINITY;
    for (std::size_t t = 0; t < turned.area.size(); ++t) {
      const Vec3<double>& n = turned.normal[t];
      best = std::min(
          best, std::max({std::abs(place(turned, t, 0) - x), std::abs(place(turned, t, 1) - y),
                          std::abs(place(turned, t, 2) - place(points, c, 2)), std::abs(n.x - nx), std::abs(n.y - ny),
                          std::abs(n.z - points.normal[c].z), std::abs(turned.area[t] - points.area[c])}));
    }
    worst = std::max(worst, best);
  }
  return worst;
}

TEST(ContactPoints, of_a_turned_or_mirrored_body_are_turned_or_mirrored) {
  const UprightBox boxes[]{{6, 4, 3, 2, 6, 0},
                           {6.3, 4.1, 3.2, 1.7, 6.1, 0},
                           {5, 3, 4, 0.4, 5, 0},
                           {5, 3, 4, 0.4, 5, M_PI / 4},
                           {-4, 7, 5, 2, 8, 0.5},
                           {0, 0, 0.6, 0.5, 4, 0.2},
                           {1, -2, 2.5, 2.5, 3.3, M_PI / 4}};
  for (const UprightBox& box : boxes)
    for (const Turn turn : {Turn{1, false}, Turn{2, false}, Turn{3, false}, Turn{0, true}, Turn{1, true}})
      EXPECT_LT(off_when_turned(box, turn), 1e-9)
          << "box at " << box.x << ", " << box.y << " by " << turn.quarters << " quarters, mirrored " << turn.mirrored;
}

/// Two points, one of each obstacle.
ContactPoints two_points() {
  ContactPoints points;
  for (int a = 0; a < 3; ++a) {
    points.cell[a] = {3 + a, 7 + a};
    points.offset[a] = {0.1 * a, -0.2 * a};
  }
  points.normal = {{0.6, 0, 0.8}, {0, 0, 1}};
  points.area = {0.3, 0.7};
  points.body = {0, 1};
  points.friction = {0.9, 0.2};
  return points;
}

TEST(ContactArrays, show_kernels_every_number_of_the_points) {
  const ContactPoints points = two_points();
  ContactArrays<float, CpuDevice> arrays(CpuDevice::make(), points, {});
  const ContactView<float> view = arrays.view();
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(view.places.cell[a][c], points.cell[a][c]);
      EXPECT_EQ(view.places.offset[a][c], static_cast<float>(points.offset[a][c]));
      EXPECT_EQ(view.places.extent[a][c], 0);
    }
    EXPECT_EQ(view.normal[c].x, static_cast<float>(points.normal[c].x));
    EXPECT_EQ(view.normal[c].z, static_cast<float>(points.normal[c].z));
    EXPECT_EQ(view.area[c], static_cast<float>(points.area[c]));
    EXPECT_EQ(view.body[c], points.body[c]);
    EXPECT_EQ(view.inverse_mass[c], 0);
    EXPECT_EQ(length(view.force[c]), 0);
    EXPECT_EQ(length(view.impulse[c]), 0);
  }
  EXPECT_EQ(view.body_friction[0], 0.9F);
  EXPECT_EQ(view.friction(1), 0.2F);
}

TEST(ContactArrays, go_on_from_the_state_of_a_checkpoint) {
  const ContactState before{.force = {1, 2, 3, 4, 5, 6}, .impulse = {7, 8, 9, 10, 11, 12}};
  ContactArrays<double, CpuDevice> arrays(CpuDevice::make(), two_points(), before);
  const ContactView<double> view = arrays.view();
  EXPECT_EQ(view.force[1].y, 5);
  EXPECT_EQ(view.impulse[0].z, 9);
  view.force[0] = {-1, 0, 0};
  view.impulse[1].x += 5;
  EXPECT_EQ(arrays.impulses()[1].x, 15);
  const ContactState after = arrays.state();
  EXPECT_EQ(after.force, (std::vector<double>{-1, 0, 0, 4, 5, 6}));
  EXPECT_EQ(after.impulse, (std::vector<double>{7, 8, 9, 15, 11, 12}));
}

TEST(ContactArrays, take_no_memory_without_points) {
  const ContactArrays<double, CpuDevice> arrays(CpuDevice::make(), {}, {});
  EXPECT_EQ(arrays.bytes(), 0u);
  EXPECT_TRUE(arrays.state().force.empty());
}

using View = ContactView<double>;

TEST(ContactLaw, gives_what_is_required_where_it_pushes_and_does_not_slip) {
  const Vec3<double> required{3, 0, 10};
  const Vec3<double> given = View::hold(required, {0, 0, 1}, 0.5);
  expect_near(given, {3, 0, 10}, 0);
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
    for (int k = 0; k < 4; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 2; i < 4; ++i) nodes.of[static_cast<std::size_t>(GridView<double>::node(slot, i, j, k))] = 1;
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

constexpr double g = 9.81;

/// An upright box as a level set, in a file of its own.
ObstacleOptions box_obstacle(const std::string& name, const Box& b, double voxel) {
  const auto file = std::filesystem::temp_directory_path() / ("talus_" + name + ".vdb");
  const auto distance = [b](double x, double y, double z) {
    const double dx = std::max(b.x0 - x, x - b.x1), dy = std::max(b.y0 - y, y - b.y1),
                 dz = std::max(b.bottom - z, z - b.top);
    return std::max({dx, dy, dz});
  };
  write_level_sets(file, {{name, {b.x0, b.y0, b.bottom}, {b.x1, b.y1, b.top}, distance}}, voxel);
  return {name, file, "", nullptr};
}

SolveOptions rigid(Integrator integrator) {
  SolveOptions o = elastic_options(1e8, integrator);
  o.implicit.step = 0.005;
  o.implicit.newmark = {0.5, 1};
  return o;
}

class SurfaceContactTest : public InEachPlace {};
TALUS_IN_EACH_PLACE(SurfaceContactTest);

TEST_P(SurfaceContactTest, wall_takes_the_momentum_of_what_it_stops) {
  Domain d = filled(ground(48, 24, 1.0, 1.0, flat), {10, 16, 8, 14, 0, 3});
  for (const Integrator integrator : moving_integrators) {
    SolveOptions o = rigid(integrator);
    o.initial_velocity = {5, 0, 0};
    o.base.law = FrictionLaw::none;
    o.obstacles = {box_obstacle("wall", {24.3, 25.1, 2, 20, -2, 6}, 0.1)};
    const SceneRun run(d, o, GetParam());
    const double came = run.solver->energies().momentum.x;
    run_to(*run.solver, 4);
    const double left = run.solver->energies().momentum.x, given = run.solver->obstacle_impulses().at(0).x;
    double farthest = 0;
    const ParticleState s = run.solver->state().points;
    for (const auto& x : positions(run.scene, s)) farthest = std::max(farthest, x[0]);
    EXPECT_NEAR(came - left, given, (integrator == Integrator::newmark ? scheme_of(o).tolerance : 1e-9) * came)
        << name_of(integrator);
    EXPECT_LT(left, 0);  // elastic: it comes back
    EXPECT_LT(farthest, 24.3);
  }
}

TEST_P(SurfaceContactTest, thin_wall_carries_earth_pressure) {
  // A column between rollers and a wall a third of a cell thick, at rest: K0 rho g H^2 W / 2 with K0 = nu / (1 - nu).
  // Nodes at whole metres, where the rollers stand.
  const Domain d = filled(ground(24, 16, 1.0, 1.0, flat, {-0.5, -0.5}), {5, 11.5, 5, 8, 0, 4});
  for (const Integrator integrator : moving_integrators) {
    SolveOptions o = rigid(integrator);
    o.damping = 0.3;
    o.base.law = FrictionLaw::none;
    o.walls = {{Axis::x, 5, Side::above}, {Axis::y, 5, Side::above}, {Axis::y, 8, Side::below}};
    o.obstacles = {box_obstacle("thin", {11.5, 11.8, 2, 14, -2, 8}, 0.1)};
    const SceneRun run(d, o, GetParam(), 6);
    const Vec3<double> before = run.solver->obstacle_impulses().at(0);
    run_to(*run.solver, 8);
    const Vec3<double> after = run.solver->obstacle_impulses().at(0);
    const double force = (after.x - before.x) / 2, k0 = o.material.poisson_ratio / (1 - o.material.poisson_ratio);
    const double expected = 0.5 * k0 * o.material.density * g * 16 * 3;
    // The wall holds the mean about its points, a tenth of a cell before it: 1.5 % of six cells. The springs of
    // implicit steps give way besides.
    EXPECT_NEAR(force, expected, (integrator == Integrator::newmark ? 0.03 : 0.02) * expected) << name_of(integrator);
  }
}

TEST_P(SurfaceContactTest, sand_stays_before_a_wall_thinner_than_a_cell) {
  Domain d = filled(ground(48, 24, 1.0, 1.0, flat), {6, 16, 4, 8, 0, 6});
  for (const Integrator integrator : moving_integrators) {
    SolveOptions o = stepping_by(integrator);
    o.material.youngs_modulus = 1e6;
    o.implicit.step = 0.02;
    o.implicit.newton_tolerance = 1e-4;
    o.initial_velocity = {6, 0, 0};
    o.walls = {{Axis::y, 3.5, Side::above}, {Axis::y, 7.5, Side::below}};
    o.obstacles = {box_obstacle("barrier", {22.2, 22.5, -2, 26, -2, 14}, 0.1)};
    o.obstacles[0].friction_angle = 15;
    const SceneRun run(d, o, GetParam(), 5);
    const ParticleState s = run.solver->state().points;
    const auto where = positions(run.scene, s);
    double beyond = 0, farthest = 0;
    for (std::size_t p = 0; p < s.size(); ++p) {
      farthest = std::max(farthest, where[p][0]);
      if (where[p][0] > 22.5) beyond += s.volume[p];
    }
    EXPECT_EQ(beyond, 0) << name_of(integrator);
    EXPECT_GT(farthest, 20.5);  // it got there
  }
}

}  // namespace
}  // namespace talus::solver::testing
