// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// mu(I) rheology with dilatancy: points in plane shear under a constant normal stress against the logistic closed form.
#include "solver/material/laws/dilatancy.hpp"

#include "tests/solver/material/any_law.hpp"

namespace talus::testing {
namespace {

constexpr double dilating_pressure =
    1e3;  // [Pa]; the elastic strain under it, 1e-4, is what the closed forms leave out

/// Grains of which a tenth more or less than at rest fills the space; with `slope` 0 the equilibrium is that of rest.
MuOfI::Options packed(double fraction, double slope = 0) {
  MuOfI::Options o;
  o.volume_fraction = fraction;
  o.volume_fraction_at_rest = 0.6;
  o.volume_fraction_slope = slope;
  o.dilatancy_rate = 4;
  return o;
}

template <class Real = double>
Material<Real> grains(const MuOfI::Options& o) {
  const auto exact = some_material<MuOfI, MaterialLaws>();
  Material<Real> m;
  m.model = exact.model;
  m.density = static_cast<Real>(exact.density);
  m.shear_modulus = static_cast<Real>(exact.shear_modulus);
  m.bulk_modulus = static_cast<Real>(exact.bulk_modulus);
  m.wave_speed = static_cast<Real>(exact.wave_speed);
  m.template numbers_of<MuOfI>() = MuOfI::numbers<Real>(o, 1.0);
  return m;
}

template <class Real>
MaterialState<Real> at_rest(const Material<Real>& m) {
  MaterialState<Real> s;
  s.log_volume = -Real(dilating_pressure) / m.bulk_modulus;
  return s;
}

/// The rate of plane shear at which grains under the pressure have this inertial number [1/s].
double rate_of(double i) { return i / MuOfI::Options{}.grain_diameter * std::sqrt(dilating_pressure / 2450); }

/// The volume fraction that is logistic in the shear (T27c): dphi/dshear = -K phi (phi - e).
double logistic(double first, double e, double k, double shear) {
  return e / (1 + (e / first - 1) * std::exp(-k * e * shear));
}

/// mu_s, mu_2, I_0 and mu_inf as Barker & Gray (2017) have them, and their creep.
double dilatant_form(const MuOfI::Options& o, double i) {
  return (o.internal_friction() * o.inertial_number + o.limiting_friction() * i + o.fast_friction_rise * i * i) /
         (o.inertial_number + i);
}
double creep(const MuOfI::Options& o, double i) {
  const double joint = o.first_well_posed(), mu = dilatant_form(o, joint);
  return std::sqrt(1.9 / (std::log(joint / i) + 1.9 / (mu * mu)));
}

template <class Real>
double fraction_of(const MuOfI::Options& o, const MaterialState<Real>& s) {
  return o.volume_fraction * std::exp(-static_cast<double>(s.plastic_log_volume));
}

/// A step of plane shear that lets the point rise as far as its normal stress stays the same.
template <class Real>
void shear_under_load(const Material<Real>& m, double shear, double seconds, MaterialState<Real>& s) {
  const MaterialState<Real> start = s;
  const double stiff = static_cast<double>(m.bulk_modulus + Real(4.0 / 3) * m.shear_modulus);
  double rise = 0, low = -0.3, high = 0.3;
  for (int n = 0; n < 80; ++n) {
    Mat3<Real> g{};
    g.c.x = static_cast<Real>(shear);
    g.c.z = static_cast<Real>(rise);
    s = start;
    advance_material(m, g, static_cast<Real>(seconds), s);
    const double excess = -static_cast<double>(kirchhoff_stress(m, s).zz) - dilating_pressure;
    if (std::abs(excess) < (sizeof(Real) == 8 ? 1e-9 : 1e-3) * dilating_pressure) break;
    (excess > 0 ? low : high) = rise;
    rise += 0.7 * excess / stiff;
    if (n > 20 || rise <= low || rise >= high) rise = 0.5 * (low + high);
  }
}

template <class Real>
double friction_of(const Material<Real>& m, const MaterialState<Real>& s) {
  const Sym3<Real> tau = kirchhoff_stress(m, s);
  return static_cast<double>(-tau.xz / tau.zz);
}

TEST(Dilatancy, leads_dense_and_loose_grains_along_the_logistic_curve_to_one_volume) {
  for (const double first : {0.64, 0.57}) {
    const MuOfI::Options o = packed(first);
    const auto m = grains(o);
    MaterialState<double> s = at_rest(m);
    constexpr double step = 1e-3, slow = 1e-6;
    for (int n = 1; n <= 3000; ++n) {
      shear_under_load(m, step, step / rate_of(slow), s);
      if (n % 100 != 0) continue;
      const double shear = n * step, phi = fraction_of(o, s), expected = logistic(first, 0.6, 4, shear);
      // Elastic shear of 1.4e-4 comes before the plastic one, at which phi changes by up to 0.1 of the shear; the
      // friction of slow flow comes on with the elastic strain that turns into the direction of dilating shear.
      EXPECT_NEAR(phi, expected, 3e-5) << shear;
      EXPECT_NEAR(friction_of(m, s), o.internal_friction() + 4 * (expected - 0.6), 1e-3) << shear;
      // The body: its volume is that of the grains over their fraction, less an elastic strain of 1.7e-4.
      EXPECT_NEAR(std::exp(s.log_volume) * phi / first, 1, 2e-4);
    }
    EXPECT_NEAR(fraction_of(o, s), 0.6, 1e-4);
  }
}

TEST(Dilatancy, adds_to_the_friction_at_its_peak_and_fades_over_shear) {
  const MuOfI::Options o = packed(0.64);
  const auto m = grains(o);
  MaterialState<double> s = at_rest(m);
  constexpr double step = 1e-4, slow = 1e-6;
  double peak = 0, after = 0;
  for (int n = 1; n <= 5000; ++n) {
    shear_under_load(m, step, step / rate_of(slow), s);
    if (friction_of(m, s) > peak) {
      peak = friction_of(m, s);
      after = n * step;
    }
  }
  // By then it has dilated a little: K phi tan(psi) = 0.4 of friction per shear.
  EXPECT_NEAR(peak, o.internal_friction() + 4 * 0.04, 3e-3);
  EXPECT_LT(after, 0.01);
  EXPECT_NEAR(friction_of(m, s), o.internal_friction() + 4 * (logistic(0.64, 0.6, 4, 0.5) - 0.6), 1e-3);
  // A loose one is weaker at first, and never above the friction of steady flow.
  const MuOfI::Options loose = packed(0.57);
  const auto n = grains(loose);
  MaterialState<double> t = at_rest(n);
  shear_under_load(n, 1e-3, 1e-3 / rate_of(slow), t);
  EXPECT_NEAR(friction_of(n, t), loose.internal_friction() - 4 * 0.03, 5e-3);
}

TEST(Dilatancy, finds_the_looser_packing_and_the_friction_of_fast_shear) {
  for (const double first : {0.64, 0.57}) {
    for (const double i : {0.01, 0.1, 0.5}) {
      const MuOfI::Options o = packed(first, 0.2);
      const auto m = grains(o);
      MaterialState<double> s = at_rest(m);
      for (int n = 0; n < 6000; ++n) shear_under_load(m, 1e-3, 1e-3 / rate_of(i), s);
      // phi_eq of that number; what is left of the way there is exp(-4 0.5 6) = 6e-6 of it. The elastic strain turns
      // with the flow, so that the pressure is a ten thousandth off the normal stress, and the number with it.
      EXPECT_NEAR(fraction_of(o, s), 0.6 - 0.2 * i, 3e-5) << i;
      // As the law without dilatancy does, whose elastic strain turns with the flow as well.
      const auto steady = grains(MuOfI::Options{});
      MaterialState<double> t = at_rest(steady);
      for (int n = 0; n < 100; ++n) shear_under_load(steady, 1e-3, 1e-3 / rate_of(i), t);
      EXPECT_NEAR(friction_of(m, s), friction_of(steady, t), 1e-4) << i;
    }
  }
}

TEST(Dilatancy, at_the_volume_of_steady_shear_is_the_law_without_it) {
  const auto m = grains(packed(0.6, 0.0)), plain = grains(MuOfI::Options{});
  for (const double shear : {300.0, 400.0, 600.0, 1e4}) {
    for (const double seconds : {1e-6, 1e-3, 1.0}) {
      const auto with = MuOfI::end<double>(m, m.numbers_of<MuOfI>(), shear, dilating_pressure, 0.0, seconds);
      const auto without = MuOfI::flow<double>(plain, plain.numbers_of<MuOfI>(), shear, dilating_pressure, seconds);
      // Both solve one equation, of which rounding is 2e-16 of the trial's stress.
      EXPECT_NEAR(with.left, without.left, 1e-13 * shear);
      EXPECT_EQ(with.dilation, 0);
    }
  }
}

/// The end of a trial that was found by at() and balance() meets the equations that they stand for.
TEST(Dilatancy, returns_to_friction_volume_and_pressure_of_one_inertial_number) {
  int flowing = 0;
  for (const SlowFlow slow : {SlowFlow::yield, SlowFlow::creep}) {
    for (const double first : {0.67, 0.64, 0.601, 0.599, 0.57, 0.54}) {
      MuOfI::Options o = packed(first, 0.2);
      o.slow_flow = slow;
      const auto m = grains(o);
      const auto& n = m.numbers_of<MuOfI>();
      for (const double p : {1.0, 1e3, 1e5}) {
        for (const double seconds : {1e-7, 1e-4, 0.1, 100.0}) {
          for (const double times : {0.2, 0.5, 0.6, 1.0, 10.0, 1e3}) {
            const double shear = times * p;
            const auto end = MuOfI::end<double>(m, n, shear, p, 0.0, seconds);
            const double pressure = p + m.bulk_modulus * end.dilation;
            ASSERT_GE(pressure, -1e-12 * p) << first << ", " << p << ", " << seconds << ", " << times;
            ASSERT_GE(end.left, 0);
            ASSERT_LE(end.left, shear);
            if (end.left == shear) continue;                                         // rests
            EXPECT_LE(end.left, steepest_cone * pressure * (1 + 1e-9) + 1e-12 * p);  // p is met to 1e-10
            // Loose grains in a long step whose volume is held lose all of their pressure but for rounding.
            if (pressure < 1e-3 * p) continue;
            ++flowing;
            const double strain = (shear - end.left) / m.shear_modulus;
            const double i = strain * o.grain_diameter / seconds / std::sqrt(pressure / o.grain_density);
            const double e = 0.6 - 0.2 * std::min(i, 0.5), phi = first * std::exp(-end.dilation);
            const double angle = 4 * (phi - e), start = 4 * (first - e);
            // The length of the deviatoric strain of a unit of plane shear, at the start of the step.
            const double length = std::sqrt(1 + 4.0 / 3 * start * start);
            // A strain that is the difference of close stresses is known to 1e-16 of them.
            const double blur = 1e-14 * shear / (shear - end.left) + 1e-9;
            EXPECT_NEAR(phi, logistic(first, e, 4, strain / length), 1e-3 * blur + 1e-9)
                << first << ", " << p << ", " << seconds << ", " << times;
            // The friction of Jop, Forterre & Pouliquen and the angle, on the plane of shear (T15d).
            const double mu = slow == SlowFlow::yield || i > o.first_well_posed() ? dilatant_form(o, i) : creep(o, i);
            const double m_plane = mu + angle, bend = std::sqrt(1 + 4.0 / 3 * angle * angle);
            const double cone = std::min(m_plane * bend / (1 + 4.0 / 3 * m_plane * angle), steepest_cone);
            EXPECT_NEAR(end.left / pressure, std::max(cone, 0.0), blur) << first << ", " << p << ", " << i;
            // Never past the packing that it tends to.
            EXPECT_GE((first - e) * (phi - e), -1e-12);
          }
        }
      }
    }
  }
  EXPECT_GT(flowing, 400);
}

TEST(Dilatancy, of_one_long_step_is_that_of_a_thousand_short_ones) {
  for (const double first : {0.64, 0.57}) {
    const MuOfI::Options o = packed(first);
    const auto m = grains(o);
    for (const double shear : {0.1, 1.0, 10.0}) {
      const double seconds = shear / rate_of(1e-6);
      MaterialState<double> once = at_rest(m), often = once;
      shear_under_load(m, shear, seconds, once);
      for (int n = 0; n < 1000; ++n) shear_under_load(m, shear / 1000, seconds / 1000, often);
      // A step takes the direction of the trial, which one of large shear turns by arctan(shear / 2): part of its
      // plastic strain is along the normal. The volume is within what 0.1 of shear more or less would make of it.
      const double to = logistic(first, 0.6, 4, shear);
      EXPECT_NEAR(fraction_of(o, often), to, 1e-4) << shear;
      EXPECT_GE((first - 0.6) * (fraction_of(o, once) - 0.6), -1e-9) << shear;
      EXPECT_NEAR(fraction_of(o, once), to, 0.15 * std::abs(first - 0.6)) << shear;
    }
  }
}

TEST(Dilatancy, of_an_open_point_is_none) {
  const auto m = grains(packed(0.64, 0.2));
  const auto end = MuOfI::end<double>(m, m.numbers_of<MuOfI>(), 100.0, -1e4, 0.01, 1e-3);
  EXPECT_EQ(end.left, 0);
  EXPECT_EQ(end.dilation, 0);
  // What has dilated by one percent carries its load at a volume at which unsheared grains were open, and opens beyond.
  MaterialState<double> s;
  s.plastic_log_volume = 0.01;
  s.log_volume = 0.01 - dilating_pressure / m.bulk_modulus;
  EXPECT_NEAR(-trace(kirchhoff_stress(m, s)) / 3, dilating_pressure, 1e-6);
  s.log_volume = 0.02;
  EXPECT_EQ(norm_squared(kirchhoff_stress(m, s)), 0);
  EXPECT_EQ(elastic_energy(m, s), 0);
  // Shear while open leaves the packing as it was.
  Mat3<double> g{};
  g.c.x = 0.01;
  for (int n = 0; n < 100; ++n) advance_material(m, g, 1e-3, s);
  EXPECT_EQ(s.plastic_log_volume, 0.01);
  // Contact is kept while what opens in a step is less than what its shear dilates, tan(psi) of the loosest packing.
  s.log_volume = 0.01 + 1e-5;
  advance_material(m, g, 1e-3, s);
  EXPECT_GT(s.plastic_log_volume, 0.01 + 1e-5);
  EXPECT_LT(s.plastic_log_volume, 0.01 + 0.01 * 4 * 0.15);
}

TEST(Dilatancy, has_the_exact_tangent) {
  for (const SlowFlow slow : {SlowFlow::yield, SlowFlow::creep}) {
    for (const double first : {0.64, 0.58}) {
      MuOfI::Options o = packed(first, 0.2);
      o.slow_flow = slow;
      expect_tangent_to_be_the_derivative(grains(o));
    }
  }
}

TEST(Dilatancy, in_single_precision_is_that_in_double) {
  for (const double first : {0.64, 0.57}) {
    const MuOfI::Options o = packed(first, 0.2);
    const auto fine = grains(o);
    const auto coarse = grains<float>(o);
    MaterialState<double> s = at_rest(fine);
    MaterialState<float> t = at_rest(coarse);
    for (int n = 0; n < 1000; ++n) {
      shear_under_load(fine, 1e-3, 1e-3 / rate_of(0.1), s);
      shear_under_load(coarse, 1e-3, 1e-3 / rate_of(0.1), t);
    }
    // Rounding of the pressure, 6e-8 of a volume change of 0.05 times K: 20 Pa of 1,000.
    EXPECT_NEAR(fraction_of(o, t), fraction_of(o, s), 1e-4);
    EXPECT_NEAR(friction_of(coarse, t), friction_of(fine, s), 0.02);
  }
}

/// No heat is taken from nothing: the work of a step of plane shear is not below what it leaves as elastic energy.
TEST(Dilatancy, makes_no_energy) {
  for (const double first : {0.64, 0.57}) {
    const auto m = grains(packed(first, 0.2));
    MaterialState<double> s = at_rest(m);
    for (int n = 0; n < 300; ++n) {
      const MaterialState<double> before = s;
      shear_under_load(m, 1e-3, 1e-3 / rate_of(0.01), s);
      const Sym3<double> tau = (kirchhoff_stress(m, before) + kirchhoff_stress(m, s)) * 0.5;
      const double work = tau.xz * 1e-3 + tau.zz * (s.log_volume - before.log_volume);
      // (T27d): what dilatancy adds to the friction it spends on lifting; mu(I) p per shear is left.
      if (n > 10) {
        EXPECT_NEAR((work - elastic_energy(m, s) + elastic_energy(m, before)) / (dilating_pressure * 1e-3), 0.4, 0.03);
      }
    }
  }
}

TEST(Dilatancy, is_off_unless_asked_for) {
  EXPECT_FALSE(MuOfI::Options{}.dilates());
  EXPECT_TRUE(packed(0.6).dilates());
  const auto faults = [](const MuOfI::Options& o) {
    std::vector<Fault> found;
    MuOfI::Options read = o;
    read.describe(*recipe::make_checker(found), {.name = "[solve.material]", .chosen = MuOfI::name});
    return found.size();
  };
  EXPECT_EQ(faults(packed(0.64)), 0u);
  EXPECT_EQ(faults(packed(0.52)), 0u);
  EXPECT_EQ(faults(packed(0.5)), 1u) << "0.382 of friction, less 4 times 0.1";
  EXPECT_NE(MuOfI::words(packed(0.64), "").find("volume fraction 0.64"), std::string::npos);
  EXPECT_EQ(MuOfI::words({}, "").find("volume fraction"), std::string::npos);
}

}  // namespace
}  // namespace talus::testing
