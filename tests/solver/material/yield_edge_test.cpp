// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent of a point that lies on the yield cone, where a step has left it (T17c).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "solver/material/tangent.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

/// Random gradients of a size.
class Gradients {
 public:
  explicit Gradients(unsigned seed) : engine_(seed) {}
  template <class Real>
  Mat3<Real> draw(double size) {
    const auto column = [&] {
      return Vec3<Real>{static_cast<Real>(size * u_(engine_)), static_cast<Real>(size * u_(engine_)),
                        static_cast<Real>(size * u_(engine_))};
    };
    return {column(), column(), column()};
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> u_{-1, 1};
};

template <class Real>
Material<Real> sand_at_yield(double dilatancy, double apex) {
  MaterialOptions o;
  o.model = MaterialModel::drucker_prager;
  o.friction_angle = 30;
  o.dilatancy_angle = dilatancy;
  o.youngs_modulus = 1e7;
  o.poisson_ratio = 0.3;
  auto m = make_material<Real>(o);
  m.apex = static_cast<Real>(apex);
  return m;
}

/// A state that has just flowed under pressure: three steps of random strain from a compressed one, of which the last
/// has yielded. Strains of some 1e-3 are those of sand under 20 kPa.
template <class Real>
MaterialState<Real> flowed(const Material<Real>& m, Gradients& random) {
  for (;;) {
    MaterialState<Real> s;
    s.log_volume = Real(-4e-3);
    for (int n = 0; n < 3; ++n) {
      s.plastic_shear = 0;
      advance_material(m, random.draw<Real>(1e-3), Real(0.01), s);
    }
    if (s.plastic_shear > Real(0) && s.log_volume - s.plastic_log_volume < Real(-1e-3)) return s;
  }
}

/// The tangent where the step begins, with `way` ahead.
template <class Real>
PointTangent<Real> tangent_ahead(const Material<Real>& m, const MaterialState<Real>& s, const Mat3<Real>& way) {
  const auto ahead = [&] { return way; };
  PointTangent<Real> t;
  nominal_stress(m, s, HeadedGradient<Real, decltype(ahead)>{{}, true, ahead}, Real(0.01), &t);
  return t;
}

template <class Real>
double size_of(const Mat3<Real>& g) {
  return static_cast<double>(std::sqrt(dot(g.a, g.a) + dot(g.b, g.b) + dot(g.c, g.c)));
}
template <class Real>
Mat3<Real> combined(const Mat3<Real>& x, Real a, const Mat3<Real>& y, Real b) {
  return {x.a * a + y.a * b, x.b * a + y.b * b, x.c * a + y.c * b};
}

/// Largest change of K dG, over |K dG| of an elastic point, when the state is moved by rounding of this share.
template <class Real>
double moved_by_rounding(double share, double dilatancy, double apex) {
  Gradients random(11);
  const auto m = sand_at_yield<Real>(dilatancy, apex);
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    const MaterialState<Real> s = flowed(m, random);
    const Mat3<Real> way = random.draw<Real>(1e-3), probe = random.draw<Real>(1);
    const Mat3<Real> before = apply(tangent_ahead(m, s, way), probe);
    for (const double sign : {-1.0, 1.0}) {
      MaterialState<Real> moved = s;
      moved.elastic = moved.elastic * static_cast<Real>(1 + sign * share);
      const Mat3<Real> after = apply(tangent_ahead(m, moved, way), probe);
      const double stiffness = 2 * static_cast<double>(m.shear_modulus) * size_of(probe);
      worst = std::max(worst, size_of(combined(after, Real(1), before, Real(-1))) / stiffness);
    }
  }
  return worst;
}

TEST(YieldEdge, tangent_does_not_hang_on_rounding) {
  // Moved by 1e-14, the tangent may change by what 1e-14 of a stress is of its rounding in axes and stretches: 1e-10.
  // By the sign of the rounding it would change by as much as half the stiffness.
  for (const double dilatancy : {0.0, 10.0}) {
    for (const double apex : {0.0, 100.0})
      EXPECT_LT(moved_by_rounding<double>(1e-14, dilatancy, apex), 1e-9) << dilatancy << " deg, apex " << apex;
  }
  // In single precision strains of 1e-3 are rounded to 1e-7 of themselves, and stretches to 1e-4 of their gaps.
  EXPECT_LT(moved_by_rounding<float>(1e-7, 0, 100), 1e-2);
}

/// The gradient less what changes the volume, or the stress less its pressure.
Mat3<double> without_trace(Mat3<double> g) {
  const double third = (g.a.x + g.b.y + g.c.z) / 3;
  g.a.x -= third;
  g.b.y -= third;
  g.c.z -= third;
  return g;
}

/// How far K dG is from the difference of the stresses at the start and a little way ahead, over that difference; of
/// sand that dilates without its pressure, which the symmetric tangent leaves to the volume.
double error_ahead(const Material<double>& m, const MaterialState<double>& s, const Mat3<double>& way) {
  constexpr double step = 1e-5;  // of a way of 1e-3: strains of 1e-8
  const Mat3<double> there = combined(way, step, way, 0.0);
  const Mat3<double> at = nominal_stress(m, s, there, 0.01, static_cast<PointTangent<double>*>(nullptr)),
                     from = nominal_stress(m, s, Mat3<double>{}, 0.01, static_cast<PointTangent<double>*>(nullptr));
  const Mat3<double> change = combined(at, 1 / step, from, -1 / step);
  const Mat3<double> error = combined(apply(tangent_ahead(m, s, way), way), 1.0, change, -1.0);
  return size_of(m.dilatancy > 0 ? without_trace(error) : error) / size_of(change);
}

TEST(YieldEdge, tangent_is_the_derivative_along_the_way_ahead) {
  // The difference along 1e-8 of strain is curved by 1e-8 over strains of 1e-3: 1e-5. A tangent of the other side
  // would be off by a tenth and more. The way leaves the volume alone, on which the frozen yield stress depends.
  for (const double dilatancy : {0.0, 10.0}) {
    for (const double apex : {0.0, 100.0}) {
      Gradients random(12);
      const auto m = sand_at_yield<double>(dilatancy, apex);
      int out = 0, in = 0;
      for (int n = 0; n < 300; ++n) {
        const MaterialState<double> s = flowed(m, random);
        const Mat3<double> way = without_trace(random.draw<double>(1e-3));
        EXPECT_LT(error_ahead(m, s, way), 1e-3) << dilatancy << " deg, apex " << apex << ", state " << n;
        MaterialState<double> end = s;
        end.plastic_shear = 0;
        advance_material(m, way, 0.01, end);
        (end.plastic_shear > 0 ? out : in) += 1;
      }
      EXPECT_GT(out, 50);
      EXPECT_GT(in, 50);
    }
  }
}

TEST(YieldEdge, tangent_is_that_of_unloading_where_no_way_is_known) {
  Gradients random(13);
  const auto m = sand_at_yield<double>(0, 100);
  for (int n = 0; n < 50; ++n) {
    const MaterialState<double> s = flowed(m, random);
    const Mat3<double> probe = random.draw<double>(1);
    PointTangent<double> t;
    nominal_stress(m, s, Mat3<double>{}, 0.01, &t);
    // Turning a part of the deviator back unloads.
    Sym3<double> back = s.elastic * -1e-3;
    const Mat3<double> way{{back.xx, back.xy, back.xz}, {back.xy, back.yy, back.yz}, {back.xz, back.yz, back.zz}};
    EXPECT_LT(size_of(combined(apply(t, probe), 1.0, apply(tangent_ahead(m, s, way), probe), -1.0)),
              1e-12 * m.shear_modulus);
  }
}

TEST(YieldEdge, an_open_point_flows_whatever_way_it_goes) {
  // No pressure, no strength: neither shear nor, without a rounded tip, volume meets any stiffness.
  const auto m = sand_at_yield<double>(0, 0);
  MaterialState<double> s;
  s.log_volume = 0.1;
  const Mat3<double> shear{{}, {}, {1e-3, 0, 0}};
  EXPECT_EQ(size_of(apply(tangent_ahead(m, s, shear), shear)), 0);
}

}  // namespace
}  // namespace talus::solver
