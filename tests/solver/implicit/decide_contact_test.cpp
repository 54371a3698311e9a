// The active set of contacts, node by node: opening, closing, slipping, sticking again.
#include "solver/implicit/decide_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::solver::testing {
namespace {

/// One node on level ground.
struct OneNode {
  double mass = 2, friction = 0.5, limit = 0, pull = 1e-9;
  Vec3<double> velocity, u, normal{0, 0, 1}, direction, way;
  Sym3<double> freed, walls = whole_space();
  Touch touch = Touch::sticks;
  ContactChanges changes{};
  bool dynamic = false, once = false;

  Constraints held() {
    return {.walls = &walls,
            .normal = &normal,
            .friction = &friction,
            .limit = &limit,
            .direction = &direction,
            .way = once ? &way : nullptr,
            .changes = &changes,
            .slip = 1e-3,
            .head_start = 1e-4,
            .pull = &pull};
  }
  NodeArrays nodes() { return {.mass = &mass, .velocity = &velocity, .u = &u, .freed = &freed, .touch = &touch}; }
  bool decide(const Vec3<double>& force) {
    return DecideContact{nodes(), held(), {.dynamic = dynamic, .step = 0.1}}.decide(0, force);
  }
};

TEST(DecideContact, keeps_what_friction_can_hold) {
  OneNode n;
  EXPECT_FALSE(n.decide({4, 0, -10}));
  EXPECT_EQ(n.touch, Touch::sticks);
  EXPECT_EQ(n.limit, 5);
}

TEST(DecideContact, lets_slip_what_friction_cannot_hold) {
  OneNode n;
  EXPECT_TRUE(n.decide({3, -4.5, -10}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_NEAR(length(n.direction), 1, 1e-15);
  EXPECT_NEAR(n.direction.x / n.direction.y, -3 / 4.5, 1e-15);
  EXPECT_EQ(n.freed.xx, 1);
  EXPECT_EQ(n.freed.zz, 0) << "the normal is held while it presses";
  EXPECT_EQ(n.changes.turns, 1);
  EXPECT_EQ(n.changes.closings, 0);
}

TEST(DecideContact, opens_where_the_contact_would_pull) {
  OneNode n;
  EXPECT_FALSE(n.decide({0, 0, 0.5e-9})) << "rounding must not open it";
  EXPECT_TRUE(n.decide({0, 0, 1}));
  EXPECT_EQ(n.touch, Touch::open);
  EXPECT_EQ(n.freed.zz, 1);
}

TEST(DecideContact, closes_where_the_node_moves_in) {
  OneNode n;
  n.touch = Touch::open;
  n.u = {0.1, 0, 0.2};
  EXPECT_FALSE(n.decide({0, 0, -1}));
  n.u.z = -0.2;
  EXPECT_TRUE(n.decide({0, 0, -1}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_EQ(n.u.x, 0.1);
  EXPECT_EQ(n.u.z, 0);
  EXPECT_EQ(n.changes.closings, 1);
  EXPECT_EQ(n.changes.turns, 0);
}

TEST(DecideContact, stays_closed_once_it_has_closed_three_times) {
  OneNode n;
  for (int time = 0; time < 3; ++time) {
    EXPECT_TRUE(n.decide({0, 0, 1})) << time;
    EXPECT_EQ(n.touch, Touch::open);
    n.u.z = -1;
    EXPECT_TRUE(n.decide({0, 0, -1})) << time;
  }
  EXPECT_EQ(n.changes.closings, 3);
  n.decide({0, 0, 1});
  EXPECT_NE(n.touch, Touch::open);
}

TEST(DecideContact, sticks_again_once_and_is_smoothed_then) {
  OneNode n;
  ASSERT_TRUE(n.decide({6, 0, -10}));
  n.u = {-0.1, 0, 0};
  EXPECT_TRUE(n.decide({6, 0, -10}));
  EXPECT_EQ(n.changes.turns, 2);
  EXPECT_TRUE(n.held().smoothed(0));
  EXPECT_EQ(n.touch, Touch::slips) << "it has changed too often: friction is smoothed instead";
  EXPECT_FALSE(n.decide({6, 0, -10}));
  // One that was taken to slip from the start has a change left.
  OneNode fresh;
  fresh.touch = Touch::slips;
  fresh.direction = {1, 0, 0};
  fresh.u = {-0.1, 0, 0};
  EXPECT_TRUE(fresh.decide({6, 0, -10}));
  EXPECT_EQ(fresh.touch, Touch::sticks);
  EXPECT_EQ(length(fresh.u), 0);
}

TEST(DecideContact, counts_what_it_takes_to_stop_a_moving_node) {
  OneNode n;
  n.dynamic = true;
  n.velocity = {1, 0, 0};
  // The reaction is 10 N and holds 5; stopping 2 kg at 1 m/s in 0.1 s takes 20.
  EXPECT_TRUE(n.decide({0, 0, -10}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_EQ(n.direction.x, 1);
}

/// Minus the derivative by central differences.
Sym3<double> differenced(const Constraints& held, const Vec3<double>& u, double h) {
  const auto change = [&](const Vec3<double>& d) {
    return (held.friction_force(0, u - d, nullptr) - held.friction_force(0, u + d, nullptr)) * (0.5 / h);
  };
  const Vec3<double> x = change({h, 0, 0}), y = change({0, h, 0}), z = change({0, 0, h});
  return {x.x, y.y, z.z, x.y, y.z, x.z};
}

TEST(FrictionForce, is_the_limit_against_the_slip) {
  OneNode n;
  n.limit = 5;
  n.direction = {1, 0, 0};
  const Vec3<double> f = n.held().friction_force(0, {3, 4, 2}, nullptr);
  EXPECT_NEAR(f.x, -3, 1e-3);
  EXPECT_NEAR(f.y, -4, 1e-3);
  EXPECT_EQ(f.z, 0);
  EXPECT_NEAR(n.held().friction_force(0, {}, nullptr).x, -5, 1e-5) << "it has its direction before it has moved";
}

TEST(FrictionForce, grows_over_the_slip_where_it_is_smoothed) {
  OneNode n;
  n.limit = 5;
  n.direction = {1, 0, 0};
  n.changes.turns = 2;
  EXPECT_EQ(length(n.held().friction_force(0, {}, nullptr)), 0);
  EXPECT_NEAR(n.held().friction_force(0, {1e-3, 0, 0}, nullptr).x, -5 / std::sqrt(2.0), 1e-12);
}

TEST(FrictionForce, has_the_derivative_that_it_says) {
  OneNode n;
  n.limit = 5;
  n.direction = {0.6, 0.8, 0};
  n.way = {0.03, 0.04, 0};
  for (const int kind : {0, 1, 2}) {
    n.changes.turns = kind == 1 ? 2 : 0;
    n.once = kind == 2;
    const Vec3<double> u{2e-3, -1e-3, 0};
    Sym3<double> got;
    n.held().friction_force(0, u, &got);
    const Sym3<double> expected = differenced(n.held(), u, 1e-8);
    const double size = std::abs(expected.xx) + std::abs(expected.yy);
    EXPECT_NEAR(got.xx, expected.xx, 1e-6 * size) << kind;
    EXPECT_NEAR(got.yy, expected.yy, 1e-6 * size) << kind;
    EXPECT_NEAR(got.xy, expected.xy, 1e-6 * size) << kind;
  }
}

}  // namespace
}  // namespace talus::solver::testing
