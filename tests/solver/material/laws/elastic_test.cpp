// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Laws without plastic flow, and laws of mud and of grains whose stress depends on the rate of shear.
#include "solver/material/laws/elastic.hpp"
#include "solver/material/laws/flowing.hpp"
#include "solver/material/laws/herschel_bulkley.hpp"
#include "solver/material/laws/mu_of_i.hpp"
#include "tests/solver/material/any_law.hpp"

namespace talus::testing {
namespace {

TEST(ElasticLaws, keep_the_trial_and_nothing_plastic) {
  MaterialState<double> state{{0.01, -0.02, 0.03, 0.004, 0.005, 0.006}, 0.02, 0};
  const Increment<double> step(Mat3<double>{}, 0.1, MeanVolume<double>{});
  ElasticLaw<Corotated>::settle<double>({}, {}, step, state);
  EXPECT_EQ(state.elastic.yy, -0.02);
  EXPECT_EQ(state.elastic.xz, 0.006);
  EXPECT_EQ(state.plastic_log_volume, 0);
  EXPECT_EQ(state.plastic_shear, 0);
}

TEST(ElasticLaws, go_on_with_all_of_the_strain_of_gravity_loading) {
  const Sym3<double> loaded{-3, -3, -6, 1, 2, 3};
  const Sym3<double> kept = ElasticLaw<Corotated>::after_loading(loaded);
  EXPECT_EQ(kept.zz, loaded.zz);
  EXPECT_EQ(kept.yz, loaded.yz);
}

/// A bar pulled to this stretch, nothing moving across.
template <class Law>
MaterialState<double> pulled(const Material<double>& m, double stretch) {
  MaterialState<double> s;
  constexpr int steps = 50;
  Mat3<double> g{};
  g.a.x = std::exp(std::log(stretch) / steps) - 1;
  for (int n = 0; n < steps; ++n) advance_material(m, g, 0.01, s);
  return s;
}

TEST(NeoHookean, has_the_stress_and_energy_of_its_closed_form) {
  const auto m = some_material<NeoHookean, MaterialLaws>();
  const double shear = m.shear_modulus, lame = m.lame();
  for (const double stretch : {0.3, 0.9, 1.2, 2.0, 6.0}) {
    const MaterialState<double> s = pulled<NeoHookean>(m, stretch);
    const Sym3<double> tau = kirchhoff_stress(m, s);
    const double square = stretch * stretch, log = std::log(stretch);
    // The logarithm's series leaves 1e-9 of the strain.
    const double size = shear * (square + 1);
    EXPECT_NEAR(tau.xx, shear * (square - 1) + lame * log, 1e-7 * size);
    EXPECT_NEAR(tau.yy, lame * log, 1e-7 * size);
    EXPECT_NEAR(elastic_energy(m, s), 0.5 * shear * (square - 1) - shear * log + 0.5 * lame * log * log, 1e-7 * size);
  }
}

TEST(NeoHookean, holds_with_a_force_that_grows_with_every_stretch_where_hencky_gives_way) {
  // The tensile force over the first section: tau / stretch.
  const auto force = [](const auto& m, double stretch) {
    return kirchhoff_stress(m, pulled<NeoHookean>(m, stretch)).xx / stretch;
  };
  const auto neo = some_material<NeoHookean, MaterialLaws>();
  const auto hencky = some_material<Hencky, MaterialLaws>();
  for (int n = 0; n < 49; ++n) {
    const double stretch = 0.2 * std::pow(1.1, n);  // to 20
    EXPECT_GT(force(neo, 1.1 * stretch), force(neo, stretch));
  }
  const double limit = std::exp(Hencky::largest_strain);
  EXPECT_GT(force(hencky, limit), force(hencky, 0.9 * limit));
  EXPECT_LT(force(hencky, 1.1 * limit), force(hencky, limit));
}

TEST(NeoHookean, has_faster_waves_where_it_is_stretched) {
  const auto m = some_material<NeoHookean, MaterialLaws>();
  EXPECT_EQ(wave_speed(m, {}), m.wave_speed);
  for (const double stretch : {0.5, 1.5, 3.0}) {
    const MaterialState<double> s = pulled<NeoHookean>(m, stretch);
    PointTangent<double> tangent;
    nominal_stress(m, s, Mat3<double>{}, 0.01, &tangent);
    const double modulus = apply(tangent, Mat3<double>{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}).a.x;
    const double found = m.density * wave_speed(m, s) * wave_speed(m, s);
    EXPECT_GT(found, 0.999999 * modulus) << "steps would be too long at a stretch of " << stretch;
    if (stretch > 1) {
      EXPECT_NEAR(found / modulus, 1, 1e-6);
    }
  }
}

Material<double> mud(const HerschelBulkley::Options& o) {
  auto m = some_material<HerschelBulkley, MaterialLaws>();
  m.numbers_of<HerschelBulkley>() = HerschelBulkley::numbers<double>(o, 1.0);
  return m;
}

HerschelBulkley::Options fluid(double exponent) {
  return {.yield_stress = 500, .consistency = 200, .flow_exponent = exponent, .solid_fraction_exponent = 0};
}

TEST(HerschelBulkley, returns_to_the_closed_form_at_any_rate_and_any_step) {
  for (const double exponent : {0.15, 0.33, 0.5, 1.0, 1.7, 3.0}) {
    const HerschelBulkley::Options o = fluid(exponent);
    const auto m = mud(o);
    for (const double rate : {1e-3, 0.1, 1.0, 20.0, 500.0}) {
      const double expected = o.yield_stress + o.consistency * std::pow(rate, exponent);
      for (const double seconds : {1e-7, 1e-4, 0.1, 100.0}) {
        const double trial = expected + m.shear_modulus * rate * seconds;
        const auto end = HerschelBulkley::flow<double>(m, m.numbers_of<HerschelBulkley>(), trial, 0, seconds);
        EXPECT_NEAR(end.left / expected, 1, 1e-8) << exponent << ", " << rate << ", " << seconds;
      }
    }
  }
}

TEST(HerschelBulkley, stiffens_with_the_solid_fraction_as_water_leaves) {
  HerschelBulkley::Options o = fluid(0.5);
  o.solid_fraction_exponent = 10;
  auto m = mud(o);
  const double drained = std::log(0.5 / 0.55);  // ln of the volume from a solid fraction of 0.5 to 0.55
  wet(m, 0.3, drained);
  const auto end = HerschelBulkley::flow<double>(m, m.numbers_of<HerschelBulkley>(), 1e9, 0, 1e9);
  EXPECT_NEAR(m.numbers_of<HerschelBulkley>().rest, 500 * std::pow(1.1, 10), 1e-9);
  const double rate = (1e9 - end.left) / m.shear_modulus / 1e9;
  EXPECT_NEAR(end.left, std::pow(1.1, 10) * (500 + 200 * std::sqrt(rate)), 1e-6);
}

TEST(HerschelBulkley, counts_its_plastic_shear) {
  const auto m = mud(fluid(1));
  MaterialState<double> s;
  Mat3<double> g{};
  g.c.x = 1e-3;  // of simple shear, of which the elastic part is left out at the end
  double plastic = 0;
  for (int n = 0; n < 100; ++n) {
    advance_material(m, g, 1e-3 / 20, s);
    plastic += s.plastic_shear;
  }
  EXPECT_NEAR(plastic * std::sqrt(3.0), 0.1 - kirchhoff_stress(m, s).xz / m.shear_modulus, 1e-3 * 0.1);
}

TEST(HerschelBulkley, has_its_stress_in_steady_simple_shear) {
  for (const double exponent : {0.4, 1.0}) {
    const HerschelBulkley::Options o = fluid(exponent);
    const auto m = mud(o);
    for (const double rate : {0.5, 20.0}) {
      MaterialState<double> s;
      Mat3<double> g{};
      g.c.x = 1e-4;
      for (int n = 0; n < 500; ++n) advance_material(m, g, 1e-4 / rate, s);
      // The elastic strain, below 1e-3, turns with the flow.
      const double expected = o.yield_stress + o.consistency * std::pow(rate, exponent);
      EXPECT_NEAR(kirchhoff_stress(m, s).xz / expected, 1, 1e-3) << exponent << ", " << rate;
    }
  }
}

TEST(HerschelBulkley, rests_below_its_yield_stress_and_is_plastic_without_viscosity) {
  HerschelBulkley::Options o = fluid(0.5);
  const auto m = mud(o);
  EXPECT_EQ(HerschelBulkley::flow<double>(m, m.numbers_of<HerschelBulkley>(), 499, 0, 1).left, 499);
  o.consistency = 0;
  const auto plastic = mud(o);
  EXPECT_EQ(HerschelBulkley::flow<double>(plastic, plastic.numbers_of<HerschelBulkley>(), 1e6, 0, 1).left, 500);
}

TEST(HerschelBulkley, carries_no_mean_tension_and_keeps_its_strength_when_it_opens) {
  const auto m = mud(fluid(1));
  MaterialState<double> s;
  s.log_volume = 0.01;
  s.elastic.xz = 100 / (2 * m.shear_modulus);
  const Sym3<double> tau = kirchhoff_stress(m, s);
  EXPECT_EQ(trace(tau), 0);
  EXPECT_NEAR(tau.xz, 100, 1e-9);
}

TEST(HerschelBulkley, has_the_exact_tangent_at_every_exponent) {
  for (const double exponent : {0.33, 1.0, 2.0}) expect_tangent_to_be_the_derivative(mud(fluid(exponent)));
}

TEST(HerschelBulkley, is_sound_in_single_precision) {
  for (const double exponent : {0.1, 0.5, 1.0, 3.0}) {
    const auto numbers = HerschelBulkley::numbers<float>(fluid(exponent), 1.0);
    Elasticity<float> m;
    m.shear_modulus = 4e6f;
    for (const float shear : {501.0f, 1e3f, 1e5f, 1e9f}) {
      for (const float seconds : {1e-7f, 1e-3f, 10.0f}) {
        const auto end = HerschelBulkley::flow<float>(m, numbers, shear, 0.0f, seconds);
        EXPECT_TRUE(end.left >= 500 && end.left <= shear) << exponent << ", " << shear << ", " << seconds;
        EXPECT_TRUE(end.by_shear >= 0 && end.by_shear <= 1);
      }
    }
  }
}

constexpr double pressed = 1e4;  // [Pa]

Material<double> granular(const MuOfI::Options& o = {}) {
  auto m = some_material<MuOfI, MaterialLaws>();
  m.numbers_of<MuOfI>() = MuOfI::numbers<double>(o, 1.0);
  return m;
}

double inertial_number(const MuOfI::Options& o, double rate) {
  return rate * o.grain_diameter / std::sqrt(pressed / o.grain_density);
}
/// mu_s, mu_2, I_0 and mu_inf as Barker & Gray (2017) have them.
double closed_form(const MuOfI::Options& o, double i) {
  const double slow = std::tan(o.static_friction_angle * M_PI / 180),
               fast = std::tan(o.limiting_friction_angle * M_PI / 180);
  return (slow * o.inertial_number + fast * i + o.fast_friction_rise * i * i) / (o.inertial_number + i);
}

/// The stress in steady plane shear at a rate [1/s], in steps of this strain.
Sym3<double> sheared(const Material<double>& m, double rate, double strain) {
  MaterialState<double> s;
  s.log_volume = -pressed / m.bulk_modulus;
  Mat3<double> g{};
  g.c.x = strain;  // dv_x/dz, at constant volume
  for (int n = 0; n < 500; ++n) advance_material(m, g, strain / rate, s);
  return kirchhoff_stress(m, s);
}

/// sqrt(J2) at the end of a step that strains by `strain` in `seconds`, from a trial at rest of the static friction.
double returned(const Material<double>& m, double rate, double seconds, double size) {
  // The trial whose end has this rate: sqrt(J2) + G rate dt.
  return MuOfI::flow<double>(m, m.numbers_of<MuOfI>(), size + m.shear_modulus * rate * seconds, pressed, seconds).left;
}

TEST(MuOfI, has_the_analytic_friction_in_steady_simple_shear) {
  const MuOfI::Options o;
  const auto m = granular();
  for (const double rate : {0.1, 10.0, 1000.0, 1e4}) {
    for (const double strain : {1e-4, 3e-4}) {
      const Sym3<double> tau = sheared(m, rate, strain);
      // The elastic strain, 1e-3, turns with the flow.
      EXPECT_NEAR(tau.xz / pressed / closed_form(o, inertial_number(o, rate)), 1, 2e-3) << rate << ", " << strain;
      EXPECT_NEAR(-trace(tau) / 3, pressed, 1e-9 * pressed);
    }
  }
  EXPECT_GT(closed_form(o, inertial_number(o, 1e4)), 1.5 * closed_form(o, inertial_number(o, 0.1)));
}

TEST(MuOfI, returns_to_the_closed_form_at_any_rate_and_any_step) {
  const MuOfI::Options o;
  const auto m = granular();
  for (const double rate : {1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e3, 1e4}) {
    const double expected = pressed * closed_form(o, inertial_number(o, rate));
    for (const double seconds : {1e-7, 1e-4, 0.1, 100.0})
      EXPECT_NEAR(returned(m, rate, seconds, expected) / expected, 1, 1e-9) << rate << ", " << seconds;
  }
}

TEST(MuOfI, rests_below_the_static_angle_and_never_pulls_grains_apart) {
  const auto m = granular();
  const double slow = pressed * std::tan(20.9 * M_PI / 180);
  const auto& n = m.numbers_of<MuOfI>();
  EXPECT_EQ(MuOfI::flow<double>(m, n, 0.999 * slow, pressed, 1.0).left, 0.999 * slow);
  EXPECT_LT(MuOfI::flow<double>(m, n, 1.001 * slow, pressed, 1.0).left, 1.001 * slow);
  EXPECT_EQ(MuOfI::flow<double>(m, n, 10.0, 0.0, 1.0).left, 0) << "opened grains carry nothing";
  // Beyond this cone the least principal stress of an extension is tensile.
  EXPECT_NEAR(MuOfI::flow<double>(m, n, 1e9, pressed, 1e-6).left, steepest_cone * pressed, 1e-9 * pressed);
}

TEST(MuOfI, creeps_by_barker_and_gray_below_the_well_posed_range) {
  MuOfI::Options o;
  o.slow_flow = SlowFlow::creep;
  const auto m = granular(o);
  const double first = o.first_well_posed();
  const double joined = closed_form(o, first);
  for (const double share : {1e-6, 1e-3, 0.1, 0.5, 0.999, 1.001, 2.0, 100.0}) {
    const double i = share * first, rate = i / o.grain_diameter * std::sqrt(pressed / o.grain_density);
    // A = I_1 exp(alpha / mu(I_1)^2): continuous at I_1.
    const double scale = std::log(first / i) + 1.9 / (joined * joined);
    const double expected = pressed * (share < 1 ? std::sqrt(1.9 / scale) : closed_form(o, i));
    for (const double seconds : {1e-6, 1e-3, 1.0, 1000.0})
      EXPECT_NEAR(returned(m, rate, seconds, expected) / expected, 1, 1e-9) << share << ", " << seconds;
  }
  // Where C of Barker et al. (2015) is zero: mu_s = 0.342, mu_2 = 0.557, I_0 = 0.069 without the rise, by hand 0.0040.
  MuOfI::Options hand;
  hand.static_friction_angle = std::atan(0.342) * 180 / M_PI;
  hand.limiting_friction_angle = std::atan(0.557) * 180 / M_PI;
  hand.inertial_number = 0.069;
  hand.fast_friction_rise = 0;
  EXPECT_NEAR(hand.first_well_posed(), 0.0040, 1e-4);
  o.limiting_friction_angle = o.static_friction_angle + 0.5;
  EXPECT_EQ(o.first_well_posed(), 0) << "a rise of half a degree is well posed nowhere";
}

/// C of Barker et al. (2015) by differences of the friction that the return itself gives.
TEST(MuOfI, is_well_posed_on_the_branch_of_creep_and_not_without_it) {
  const auto condition = [](const MuOfI::Options& o, double i) {
    const auto m = granular(o);
    const auto friction = [&](double number) {
      const double rate = number / o.grain_diameter * std::sqrt(pressed / o.grain_density), seconds = 1e3;
      double mu = closed_form(o, number);
      for (int n = 0; n < 60; ++n) mu = returned(m, rate, seconds, mu * pressed) / pressed;  // its own trial
      return mu;
    };
    const double step = 1e-3, mu = friction(i);
    const double x = (friction(i * (1 + step)) - friction(i * (1 - step))) / (2 * step) / mu;
    return 4 * x * x - 4 * x + mu * mu * (1 - x / 2) * (1 - x / 2);
  };
  MuOfI::Options o;
  EXPECT_GT(condition(o, 1e-4), 0);
  o.slow_flow = SlowFlow::creep;
  EXPECT_LT(condition(o, 1e-4), 0);
  EXPECT_LT(condition(o, 1e-3), 0);
  EXPECT_LT(condition(o, 0.1), 0);
}

TEST(MuOfI, has_the_exact_tangent_of_its_creep_too) {
  MuOfI::Options o;
  o.slow_flow = SlowFlow::creep;
  expect_tangent_to_be_the_derivative(granular(o));
}

}  // namespace
}  // namespace talus::testing
