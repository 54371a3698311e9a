// A rate-dependent law, put into the list behind the solver's own: rate and length of the step reach it.
#include "tests/solver/material/laws/mu_of_i.hpp"

#include <gtest/gtest.h>

#include "tests/solver/material/any_law.hpp"

namespace talus::testing {
namespace {

using Laws = LawList<DruckerPrager, Hencky, Corotated, LinearElastic, MuOfI>;

double analytic(const MuOfI::Options& o, double rate, double pressure) {
  const double i = rate * o.grain_diameter / std::sqrt(pressure / o.grain_density);
  return o.static_coefficient + (o.limiting_coefficient - o.static_coefficient) / (o.inertial_number / i + 1);
}

TEST(MuOfI, has_the_analytic_friction_in_steady_simple_shear) {
  const MuOfI::Options o;
  const auto m = some_material<MuOfI, Laws>();
  const double pressure = 1e4;
  for (const double rate : {0.1, 10.0, 1000.0, 1e5}) {
    for (const double strain : {1e-4, 3e-4}) {  // of a step
      const double dt = strain / rate;
      MaterialState<double> s;
      s.log_volume = -pressure / m.bulk_modulus;
      Mat3<double> g{};
      g.c.x = strain;  // dv_x/dz, at constant volume
      for (int n = 0; n < 500; ++n) advance_material(m, g, dt, s);
      const Sym3<double> tau = kirchhoff_stress(m, s);
      // The elastic strain, 1e-3, turns with the flow.
      EXPECT_NEAR(tau.xz / pressure / analytic(o, rate, pressure), 1, 2e-3) << "rate " << rate << ", dt " << dt;
      EXPECT_NEAR(-trace(tau) / 3, pressure, 1e-9 * pressure);
    }
  }
  EXPECT_GT(analytic(o, 1e5, pressure), 1.5 * analytic(o, 0.1, pressure)) << "the rates make a difference";
}

TEST(MuOfI, is_found_by_its_number_and_changes_no_other_law) {
  const auto sand = some_material<DruckerPrager, Laws>();
  const auto plain = some_material<DruckerPrager, MaterialLaws>();
  MaterialState<double> a, b;
  const Mat3<double> g{{-2e-3, 1e-3, 0}, {0, -1e-3, 5e-4}, {1e-3, 0, -2e-3}};
  for (int n = 0; n < 5; ++n) {
    advance_material(sand, g, 0.01, a);
    advance_material(plain, g, 0.01, b);
  }
  EXPECT_EQ(kirchhoff_stress(sand, a).xz, kirchhoff_stress(plain, b).xz);
  EXPECT_NE(kirchhoff_stress(some_material<MuOfI, Laws>(), a).xx, 0);
}

TEST(MuOfI, meets_what_every_law_must) { expect_laws_to_hold<Laws>(); }

}  // namespace
}  // namespace talus::testing
