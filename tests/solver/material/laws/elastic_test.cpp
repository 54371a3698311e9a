// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Laws without plastic flow.
#include "solver/material/laws/elastic.hpp"

#include "solver/material/laws/corotated.hpp"
#include "solver/material/laws/hencky.hpp"
#include "solver/material/laws/neo_hookean.hpp"
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

TEST(ElasticLaws, neither_soften_nor_dilate) {
  EXPECT_FALSE(ElasticLaw<Corotated>::Options{}.softens());
  EXPECT_FALSE(ElasticLaw<Corotated>::Options{}.dilates());
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

}  // namespace
}  // namespace talus::testing
