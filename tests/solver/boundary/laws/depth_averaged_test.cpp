// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Friction by a table, laws of depth-averaged models against their formulas, and two laws put into the list.
#include "solver/boundary/laws/coulomb.hpp"
#include "solver/boundary/laws/frictionless.hpp"
#include "solver/boundary/laws/pouliquen.hpp"
#include "solver/boundary/laws/samosat.hpp"
#include "solver/boundary/laws/table.hpp"
#include "solver/boundary/laws/velocity_weakening.hpp"
#include "solver/options/solve.hpp"
#include "tests/solver/boundary/any_law.hpp"
#include "tests/solver/boundary/laws/speed_power.hpp"

namespace talus::testing {
namespace {

BaseFriction<double> bed_of(recipe::Pairs rows) {
  OptionsOfLaws<FrictionLaws> o;
  o.table = std::move(rows);
  return some_bed<FrictionTable, FrictionLaws>(o);
}

/// Rows of a coefficient as large as the speed.
recipe::Pairs as_many(int rows) {
  recipe::Pairs table;
  for (int row = 0; row < rows; ++row) table.push_back({1.0 * row, 1.0 * row});
  return table;
}

template <class Real>
Real coefficient(const BaseFriction<Real>& f, Real speed) {
  return f.coefficient(f.uniform, {speed, 0, Real(0.01)});
}

TEST(FrictionTable, is_linear_between_its_rows_and_constant_beyond_them) {
  const auto f = bed_of({{0.5, 0.7}, {1, 0.5}, {3, 0.1}});
  for (const auto& [speed, mu] :
       {std::pair{0.0, 0.7}, {0.5, 0.7}, {0.75, 0.6}, {1.0, 0.5}, {2.0, 0.3}, {3.0, 0.1}, {1e9, 0.1}})
    EXPECT_DOUBLE_EQ(coefficient(f, speed), mu) << speed;
  EXPECT_FLOAT_EQ(coefficient(f.as<float>(), 2.0F), 0.3F);
  EXPECT_FLOAT_EQ(coefficient(f.as<float>(), 1e9F), 0.1F);
}

TEST(FrictionTable, may_have_one_row_and_the_most_rows) {
  EXPECT_EQ(coefficient(bed_of({{2, 0.4}}), 0.0), 0.4);
  EXPECT_EQ(coefficient(bed_of({{2, 0.4}}), 9.0), 0.4);
  const auto f = bed_of(as_many(FrictionTable::most_rows));  // mu = v
  for (const double speed : {0.0, 0.3, 22.5, 23.0}) EXPECT_DOUBLE_EQ(coefficient(f, speed), speed);
  EXPECT_EQ(coefficient(f, 24.0), 23);
}

TEST(FrictionTable, carries_its_share_of_the_normal_stress) {
  double numbers[FrictionTable::constant_count];
  FrictionTable::constants(OptionsOfLaws<FrictionLaws>{}, {.borne = 0.25, .density = 0, .gravity = 0}, numbers);
  EXPECT_EQ(numbers[FrictionTable::mu], 0.25 * 0.6);
  EXPECT_EQ(numbers[FrictionTable::speed + 1], 10);
}

/// The fault of a table; "" where there is none.
std::string fault_of(recipe::Pairs rows) {
  FrictionTable::Options o{std::move(rows)};
  std::vector<Fault> faults;
  o.describe(*recipe::make_checker(faults), {.name = "[solve.base]", .chosen = "table"});
  return faults.empty() ? "" : faults.front().what;
}

TEST(FrictionTable, is_refused_unless_its_rows_make_a_function) {
  EXPECT_EQ(fault_of({{0, 0.3}, {1, 0.2}}), "");
  EXPECT_EQ(fault_of({{0, 0.3}, {0, 0.2}}), "[solve.base] table: speeds do not increase");
  EXPECT_EQ(fault_of({}), "[solve.base] table has 0 rows");
  EXPECT_EQ(fault_of(as_many(25)), "[solve.base] table has 25 rows");
}

constexpr double density = 2000;  // of some_bed()
double tangent(double angle) { return std::tan(angle * std::numbers::pi / 180); }

/// A column of this depth on a slope, at a speed.
Slip<double> column(double depth, double speed, double slope = 0) {
  const double load = density * depth, cosine = std::cos(slope * std::numbers::pi / 180);
  return {speed, load * 9.81 * cosine, 0.01, load};
}

TEST(Samosat, is_the_friction_of_com1DFA) {
  OptionsOfLaws<FrictionLaws> o;
  o.minimum_shear = 70;
  const auto f = some_bed<Samosat, FrictionLaws>(o);
  for (const double depth : {0.02, 0.5, 3.0}) {
    for (const double speed : {0.0, 2.0, 40.0}) {
      const Slip<double> slip = column(depth, speed);
      const double sigma = slip.normal_stress, rs = density * speed * speed / sigma;
      const double layer = std::log(std::max(depth / 0.05, 1.0)) / 0.43 + 4.13;
      const double tau = 70 + sigma * 0.155 * (1 + 0.222 / (0.222 + rs)) + density * speed * speed / (layer * layer);
      EXPECT_NEAR(f.coefficient(f.uniform, slip) * sigma + f.drag(f.uniform, slip) + f.yield(f.uniform, slip), tau,
                  1e-9 * tau)
          << depth << " m, " << speed << " m/s";
    }
  }
  EXPECT_DOUBLE_EQ(f.coefficient(f.uniform, column(1, 0)), 2 * 0.155);
  EXPECT_NEAR(f.coefficient(f.uniform, column(1, 1e4)), 0.155, 1e-6);
}

TEST(Voellmy, has_the_cohesion_of_bartelt) {
  OptionsOfLaws<FrictionLaws> o;
  o.friction_angle = 15;
  o.bartelt_cohesion = 200;
  const auto f = some_bed<Voellmy, FrictionLaws>(o);
  const double mu = tangent(15);
  for (const double normal : {1.0, 200.0, 1e4}) {
    const Slip<double> slip{3, normal, 0.01, normal / 9.81};
    const double expected = (1 - mu) * 200 - (1 - mu) * 200 * std::exp(-normal / 200);
    EXPECT_NEAR(f.yield(f.uniform, slip), expected, 1e-12 * 200) << "N = " << normal;
  }
  EXPECT_EQ(f.yield(f.uniform, {3, 0, 0.01, 0}), 0) << "nothing presses";
  EXPECT_NEAR(f.yield(f.uniform, {3, 1e-3, 0.01, 0}) / 1e-3, 1 - mu, 1e-4) << "next to nothing presses";
  EXPECT_TRUE(f.has_traction());
  o.friction_angle = 50;  // a raster may say so: the recipe is refused
  const auto steep = some_bed<Voellmy, FrictionLaws>(o);
  EXPECT_EQ(steep.yield(steep.uniform, {3, 1e3, 0.01, 1e2}), 0);
}

/// The bed of glass beads and its thicknesses at which flows stop and start.
struct Beads {
  OptionsOfLaws<FrictionLaws> o;
  double h_stop(double slope) const {
    return o.layer_length * (tangent(o.steepest_angle) - tangent(slope)) / (tangent(slope) - tangent(o.stop_angle));
  }
  double h_start(double slope) const {
    const double spread = tangent(o.steepest_angle) - tangent(o.stop_angle);
    return o.layer_length * (spread / (tangent(slope) - tangent(o.start_angle)) - 1);
  }
};

TEST(Pouliquen, balances_a_slope_in_the_steady_flow_of_its_flow_rule) {
  Beads b;
  for (const double gamma : {0.0, 0.77}) {
    b.o.flow_rule_offset = gamma;
    b.o.flow_rule_slope = gamma > 0 ? 0.63 : 0.136;
    const auto f = some_bed<Pouliquen, FrictionLaws>(b.o);
    for (const double slope : {23.0, 26.0, 29.0}) {
      for (const double times : {2.5, 4.0, 20.0}) {
        const double depth = times * b.h_stop(slope), froude = b.o.flow_rule_slope * times - gamma;
        const double wave = std::sqrt(9.81 * depth * std::cos(slope * std::numbers::pi / 180));
        EXPECT_NEAR(f.coefficient(f.uniform, column(depth, froude * wave, slope)), tangent(slope), 1e-12)
            << slope << " deg, " << times << " h_stop";
      }
    }
  }
}

TEST(Pouliquen, holds_what_rests_up_to_h_start_and_what_flows_slowest_up_to_h_stop) {
  const Beads b;
  const auto f = some_bed<Pouliquen, FrictionLaws>(b.o);
  for (const double slope : {23.0, 26.0, 29.0}) {
    EXPECT_NEAR(f.coefficient(f.uniform, column(b.h_start(slope), 0, slope)), tangent(slope), 1e-12);
    const double depth = b.h_stop(slope), wave = std::sqrt(9.81 * depth * std::cos(slope * std::numbers::pi / 180));
    EXPECT_NEAR(f.coefficient(f.uniform, column(depth, b.o.flow_rule_slope * wave, slope)), tangent(slope), 1e-12);
    EXPECT_GT(b.h_start(slope), b.h_stop(slope));
  }
}

TEST(Pouliquen, falls_from_rest_to_the_slowest_flow_and_grows_from_there) {
  const Beads b;
  const auto f = some_bed<Pouliquen, FrictionLaws>(b.o);
  const double depth = 0.002, wave = std::sqrt(9.81 * depth);
  double before = f.coefficient(f.uniform, column(depth, 0));
  for (int n = 1; n <= 40; ++n) {
    const double froude = b.o.flow_rule_slope * n / 20, mu = f.coefficient(f.uniform, column(depth, froude * wave));
    EXPECT_EQ(mu < before, n <= 20) << "Froude number " << froude;
    EXPECT_LT(std::abs(mu - before), 0.004) << "without a jump";
    before = mu;
  }
}

/// How many faults the recipe of a bed of this law has.
template <class Change>
std::size_t faults_of(FrictionLaw law, const Change& change) {
  solver::SolveOptions o;
  o.base.law = law;
  change(o.base);
  std::vector<Fault> faults;
  recipe::find_unmet(o, faults);
  return faults.size();
}

TEST(Pouliquen, refuses_numbers_that_contradict_one_another) {
  using solver::BaseOptions;
  EXPECT_EQ(faults_of(FrictionLaw::pouliquen, [](BaseOptions&) {}), 0u);
  EXPECT_EQ(faults_of(FrictionLaw::pouliquen, [](BaseOptions& o) { o.steepest_angle = 20; }), 1u);
  EXPECT_EQ(faults_of(FrictionLaw::pouliquen, [](BaseOptions& o) { o.start_angle = 20; }), 1u);
  EXPECT_EQ(faults_of(FrictionLaw::coulomb, [](BaseOptions& o) { o.steepest_angle = 20; }), 0u) << "of another law";
}

TEST(Voellmy, refuses_a_cohesion_that_would_push) {
  const auto faults = [](double angle, FrictionLaw law) {
    return faults_of(law, [&](solver::BaseOptions& o) {
      o.friction_angle = angle;
      o.bartelt_cohesion = 100;
    });
  };
  EXPECT_EQ(faults(50, FrictionLaw::voellmy), 1u);
  EXPECT_EQ(faults(40, FrictionLaw::voellmy), 0u);
  EXPECT_EQ(faults(50, FrictionLaw::coulomb), 0u);
}

/// Friction that is told everything: mu = sigma / (1 MPa) + dt / (1 s).
struct Told : FrictionlessLaw<Told> {
  static constexpr std::string_view name = "told";
  static constexpr bool rubs = true, asks_pressure = true;
  template <class All>
  static std::string words(const All&) {
    return "told";
  }
  template <class All>
  static std::string sentence(const All&) {
    return "friction";
  }
  template <class Real>
  TALUS_HD static Real coefficient(const LawNumbers<Real>&, const Slip<Real>& slip) {
    return slip.normal_stress / Real(1e6) + slip.duration;
  }
};

using Laws = LawList<Coulomb, VelocityWeakening, Voellmy, NoFriction, Stick, SpeedPower>;
using MoreLaws = LawList<Coulomb, VelocityWeakening, Voellmy, NoFriction, Stick, SpeedPower, Told>;

TEST(SpeedPower, has_the_coefficient_of_its_power) {
  OptionsOfLaws<Laws> o;
  o.reference_coefficient = 0.3;
  o.reference_speed = 4;
  o.speed_exponent = 0.5;
  const auto f = some_bed<SpeedPower, Laws>(o);
  for (const double speed : {0.0, 1.0, 4.0, 36.0})
    EXPECT_DOUBLE_EQ(f.coefficient(f.uniform, {speed, 1e4, 0.01}), 0.3 * std::sqrt(speed / 4));
  const BaseFriction<float, Laws> single{.law = f.law, .uniform = f.uniform.as<float>()};
  EXPECT_FLOAT_EQ(single.coefficient(single.uniform, {16.0F, 1e4F, 0.01F}), 0.6F);
}

TEST(SpeedPower, slows_a_node_on_the_bed) {
  const auto f = some_bed<SpeedPower, Laws>();  // 0.4 (v / 10)^(1/4)
  const Vec3<double> v = meet_ground(f, 0, Vec3<double>{10, 0, -2}, 0.0, 0.0, {.duration = 0.01});
  EXPECT_DOUBLE_EQ(v.x, 10 - 0.4 * 2);
  EXPECT_EQ(v.z, 0);
}

TEST(SpeedPower, meets_what_every_law_must) { expect_laws_to_hold<MoreLaws>(); }

TEST(BasalLaws, are_told_normal_stress_and_step) {
  const auto f = some_bed<Told, MoreLaws>();
  EXPECT_FALSE(f.has_traction());
  EXPECT_TRUE(f.asks_pressure());
  // 1 kg per m2 that loses 2 m/s in 10 ms presses with 200 Pa.
  const Vec3<double> v = meet_ground(f, 0, Vec3<double>{3, 0, -2}, 0.0, 0.0, {.duration = 0.01, .grip = 0.01});
  EXPECT_DOUBLE_EQ(v.x, 3 - (200 / 1e6 + 0.01) * 2);
}

}  // namespace
}  // namespace talus::testing
