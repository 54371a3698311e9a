// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Herschel-Bulkley mud: its stress at a given rate of shear against the closed form, whatever the step.
#include "solver/material/laws/herschel_bulkley.hpp"

#include <gtest/gtest.h>

#include "solver/material/laws/flowing.hpp"
#include "tests/solver/material/any_law.hpp"

namespace talus::testing {
namespace {

Material<double> mud(const HerschelBulkley::Options& o) {
  auto m = some_material<HerschelBulkley, MaterialLaws>();
  m.numbers_of<HerschelBulkley>() = HerschelBulkley::numbers<double>(o, 1.0);
  return m;
}

HerschelBulkley::Options fluid(double exponent) {
  return {.yield_stress = 500, .consistency = 200, .flow_exponent = exponent};
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

}  // namespace
}  // namespace talus::testing
