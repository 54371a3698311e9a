// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two laws put into the list behind the solver's own: speed, normal stress and the length of the step reach them.
#include "tests/solver/boundary/laws/speed_power.hpp"

#include <gtest/gtest.h>

#include "solver/boundary/laws/coulomb.hpp"
#include "solver/boundary/laws/frictionless.hpp"
#include "solver/boundary/laws/none.hpp"
#include "solver/boundary/laws/stick.hpp"
#include "solver/boundary/laws/velocity_weakening.hpp"
#include "tests/solver/boundary/any_law.hpp"

namespace talus::testing {
namespace {

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
