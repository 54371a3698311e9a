// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Consistent tangents against finite differences, at random states and on the cone.
#include "solver/material/tangent.hpp"

#include <gtest/gtest.h>

#include <random>

#include "solver/material/point_tangent.hpp"
#include "solver/material/strain.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

using M = Mat3<double>;

class RandomTensors {
 public:
  explicit RandomTensors(unsigned seed) : engine_(seed) {}
  Vec3<double> vector(double size) { return {size * u_(engine_), size * u_(engine_), size * u_(engine_)}; }
  M matrix(double size) { return {vector(size), vector(size), vector(size)}; }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> u_{-1, 1};
};

M sum(const M& a, const M& b, double t) { return {a.a + b.a * t, a.b + b.b * t, a.c + b.c * t}; }
double inner(const M& a, const M& b) { return dot(a.a, b.a) + dot(a.b, b.b) + dot(a.c, b.c); }
double norm(const M& a) { return std::sqrt(inner(a, a)); }

double worst_error(const Material<double>& m, const MaterialState<double>& start, const M& g, const M& direction,
                   double step) {
  PointTangent<double> t;
  nominal_stress(m, start, g, 0.01, &t);
  const M exact = apply(t, direction);
  const M up = nominal_stress<double>(m, start, sum(g, direction, step), 0.01, nullptr);
  const M down = nominal_stress<double>(m, start, sum(g, direction, -step), 0.01, nullptr);
  M difference = sum(up, down, -1);
  difference = {difference.a * (0.5 / step), difference.b * (0.5 / step), difference.c * (0.5 / step)};
  return norm(sum(difference, exact, -1)) / norm(exact);
}

Material<double> material(MaterialModel model) {
  MaterialOptions o;
  o.model = model;
  o.friction_angle = 30;
  o.youngs_modulus = 1e7;
  o.poisson_ratio = 0.3;
  return make_material<double>(o);
}

TEST(Tangent, of_hencky_elasticity_matches_finite_differences) {
  RandomTensors random(1);
  for (const auto model : {MaterialModel::hencky, MaterialModel::corotated}) {
    const auto m = material(model);
    for (const double size : {1e-6, 1e-3, 0.1}) {
      for (int n = 0; n < 50; ++n) {
        MaterialState<double> start;
        start.elastic = {0.1 * size, -0.3 * size, 0.2 * size, 0.05 * size, -0.1 * size, 0.15 * size};
        if (n % 5 == 0) start.elastic = {};  // equal stretches at the start
        const M g = n % 7 == 0 ? M{} : random.matrix(size);
        EXPECT_LT(worst_error(m, start, g, random.matrix(1), 1e-6), 2e-7) << "size " << size;
      }
    }
  }
}

TEST(Tangent, of_the_linear_step_is_hookes_law) {
  RandomTensors random(2);
  const auto m = material(MaterialModel::linear_elastic);
  MaterialState<double> start;
  start.elastic = {1e4, 2e4, -1e4, 3e3, 0, 1e3};
  EXPECT_LT(worst_error(m, start, random.matrix(1e-3), random.matrix(1), 1e-4), 1e-9);
}

TEST(Tangent, is_symmetric) {
  RandomTensors random(3);
  for (const auto model : {MaterialModel::hencky, MaterialModel::corotated, MaterialModel::drucker_prager}) {
    const auto m = material(model);
    for (int n = 0; n < 50; ++n) {
      MaterialState<double> start;
      start.elastic = deviator(Sym3<double>{1e-3, -2e-3, 5e-4, 3e-4, -1e-4, 2e-4});
      start.log_volume = -2e-3;
      const M g = random.matrix(5e-3), u = random.matrix(1), v = random.matrix(1);
      PointTangent<double> t;
      nominal_stress(m, start, g, 0.01, &t);
      const double uv = inner(u, apply(t, v)), vu = inner(v, apply(t, u));
      EXPECT_NEAR(uv, vu, 1e-9 * norm(u) * norm(apply(t, v)));
    }
  }
}

TEST(Tangent, of_a_yielding_point_is_exact_but_for_the_pressure_in_its_friction) {
  RandomTensors random(4);
  auto m = material(MaterialModel::drucker_prager);
  int yielding = 0;
  for (int n = 0; n < 200; ++n) {
    m.apex = n < 100 ? 0 : 2e3;  // a sharp tip, a rounded one
    MaterialState<double> start;
    start.log_volume = -2e-3;
    const M g = random.matrix(3e-3);
    if (start.log_volume + log_volume_change(g) >= 0) continue;  // open: no stress, no stiffness
    // Isochoric directions leave the pressure alone: dl = dG F^-1 without trace.
    M direction = random.matrix(1);
    const M f{{g.a.x + 1, g.a.y, g.a.z}, {g.b.x, g.b.y + 1, g.b.z}, {g.c.x, g.c.y, g.c.z + 1}};
    const M l = [&] {
      M d{direction * inverted(f).a, direction * inverted(f).b, direction * inverted(f).c};
      const double third = (d.a.x + d.b.y + d.c.z) / 3;
      d.a.x -= third;
      d.b.y -= third;
      d.c.z -= third;
      return d;
    }();
    direction = {l * f.a, l * f.b, l * f.c};
    MaterialState<double> end = start;
    advance_material(m, g, 0.01, end);
    const auto tau = kirchhoff_stress(m, end);
    const double shear = std::sqrt(0.5 * norm_squared(deviator(tau)));
    yielding += shear > 0.999 * m.friction * -trace(tau) / 3 ? 1 : 0;
    EXPECT_LT(worst_error(m, start, g, direction, 1e-8), 1e-5);
  }
  EXPECT_GT(yielding, 10);
}

TEST(CutPressure, is_rounded_over_the_apex_alone) {
  Material<double> m;
  for (const double y : {-5e3, -10.0, 0.0, 10.0, 5e3}) {
    m.apex = 0;
    const double sharp = CutPressure<double>(m, y).value;
    EXPECT_EQ(sharp, std::max(y, 0.0));
    m.apex = 100;
    const CutPressure<double> round(m, y);
    EXPECT_GT(round.value, sharp);
    EXPECT_LE(round.value - sharp, 50);
    if (std::abs(y) > 1e3) {
      EXPECT_LT(round.value - sharp, 0.6);
    }
    constexpr double e = 1e-3;
    EXPECT_NEAR(round.slope, (CutPressure<double>(m, y + e).value - CutPressure<double>(m, y - e).value) / (2 * e),
                1e-8);
  }
}

TEST(NominalStress, is_what_the_stress_update_ends_with) {
  RandomTensors random(5);
  for (const auto model : {MaterialModel::hencky, MaterialModel::corotated, MaterialModel::drucker_prager}) {
    const auto m = material(model);
    for (int n = 0; n < 50; ++n) {
      MaterialState<double> start;
      start.elastic = deviator(Sym3<double>{1e-3, -2e-3, 5e-4, 3e-4, -1e-4, 2e-4});
      start.log_volume = model == MaterialModel::drucker_prager ? -1e-3 : 0;
      const M g = random.matrix(4e-3);
      const M p = nominal_stress<double>(m, start, g, 0.01, nullptr);
      MaterialState<double> end = start;
      advance_material(m, g, 0.01, end);
      const auto tau = kirchhoff_stress(m, end);
      const M f{{g.a.x + 1, g.a.y, g.a.z}, {g.b.x, g.b.y + 1, g.b.z}, {g.c.x, g.c.y, g.c.z + 1}};
      // tau = P F^T: column k of F^T is row k of F.
      const Vec3<double> first = p * Vec3<double>{f.a.x, f.b.x, f.c.x};
      EXPECT_NEAR(first.x, tau.xx, 1e-8 * (std::abs(tau.xx) + 1e4));
      EXPECT_NEAR(first.y, tau.xy, 1e-8 * (std::abs(tau.xy) + 1e4));
      EXPECT_NEAR(first.z, tau.xz, 1e-8 * (std::abs(tau.xz) + 1e4));
    }
  }
}

}  // namespace
}  // namespace talus::solver
