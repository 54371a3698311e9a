// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of laws; consistent tangents against finite differences, at random states and on the cone.
#include "solver/material/tangent.hpp"
#include "solver/material/law.hpp"
#include "solver/material/law_list.hpp"
#include "solver/material/laws/elastic.hpp"
#include "solver/material/point_tangent.hpp"
#include "solver/material/state.hpp"
#include "solver/options/solve.hpp"
#include "tests/solver/material/any_law.hpp"

namespace talus::testing {
namespace {

TEST(MaterialLaws, hold_what_every_law_must) { expect_laws_to_hold<MaterialLaws>(); }

TEST(MaterialLaws, are_numbered_in_the_order_of_the_list) {
  EXPECT_EQ(model_of<DruckerPrager>, MaterialModel::drucker_prager);
  EXPECT_EQ(model_of<Hencky>, MaterialModel::hencky);
  EXPECT_EQ(model_of<Corotated>, MaterialModel::corotated);
  EXPECT_EQ(model_of<LinearElastic>, MaterialModel::linear_elastic);
  EXPECT_EQ(model_of<NeoHookean>, MaterialModel::neo_hookean);
  EXPECT_EQ(model_of<MuOfI>, MaterialModel::mu_of_i);
  EXPECT_EQ(model_of<HerschelBulkley>, MaterialModel::herschel_bulkley);
}

TEST(MaterialLaws, load_gravity_elastically) {
  const Sym3<double> strain{-3, -3, -6, 1, 2, 3};
  for (const auto model : {MaterialModel::drucker_prager, MaterialModel::mu_of_i, MaterialModel::herschel_bulkley}) {
    EXPECT_EQ(model_while_loading(model), MaterialModel::hencky);
    EXPECT_EQ(trace(after_loading(model, strain)), 0);
  }
  for (const auto model : {MaterialModel::hencky, MaterialModel::corotated, MaterialModel::linear_elastic}) {
    EXPECT_EQ(model_while_loading(model), model);
    EXPECT_EQ(trace(after_loading(model, strain)), -12);
  }
}

TEST(Material, of_sand_alone_is_no_larger_than_elasticity_model_and_cone) {
  EXPECT_LE(sizeof(Material<double, LawList<DruckerPrager>>), 14 * sizeof(double));
  EXPECT_LE(sizeof(Material<float, LawList<DruckerPrager>>), 14 * sizeof(float));
  EXPECT_LE(sizeof(Material<double>), 30 * sizeof(double)) << "a kernel's arguments hold eight of them";
}

struct First {
  static constexpr std::string_view name = "first";
  static constexpr int number = 1;
};
struct Second {
  static constexpr std::string_view name = "second";
  static constexpr int number = 2;
};
using Both = LawList<First, Second>;

TEST(LawLists, know_the_place_of_each_law) {
  EXPECT_EQ(Both::count, 2);
  EXPECT_EQ(Both::index_of<First>(), 0);
  EXPECT_EQ(Both::index_of<Second>(), 1);
  EXPECT_EQ(Both::names(), (std::vector<std::string_view>{"first", "second"}));
}

TEST(LawLists, show_the_law_of_a_number_and_all_laws_in_order) {
  for (int index = 0; index < Both::count; ++index)
    EXPECT_EQ(visit_law(Both{}, index, [](auto law) { return law.number; }), index + 1);
  std::string all;
  Both::each([&](auto law) { all += law.name; });
  EXPECT_EQ(all, "firstsecond");
}

using solver::make_material;
using solver::MaterialOptions;
using M = Mat3<double>;

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

double inner(const M& a, const M& b) { return dot(a.a, b.a) + dot(a.b, b.b) + dot(a.c, b.c); }

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

template <class Real = double>
Material<Real> material(MaterialModel model, double dilatancy = 0) {
  MaterialOptions o;
  o.model = model;
  o.friction_angle = 30;
  o.dilatancy_angle = dilatancy;
  o.youngs_modulus = 1e7;
  o.poisson_ratio = 0.3;
  return make_material<Real>(o);
}

TEST(Tangent, of_hencky_elasticity_matches_finite_differences) {
  Gradients random(1);
  for (const auto model : {MaterialModel::hencky, MaterialModel::corotated}) {
    const auto m = material(model);
    for (const double size : {1e-6, 1e-3, 0.1}) {
      for (int n = 0; n < 50; ++n) {
        MaterialState<double> start;
        start.elastic = {0.1 * size, -0.3 * size, 0.2 * size, 0.05 * size, -0.1 * size, 0.15 * size};
        if (n % 5 == 0) start.elastic = {};  // equal stretches at the start
        const M g = n % 7 == 0 ? M{} : random.draw<double>(size);
        EXPECT_LT(worst_error(m, start, g, random.draw<double>(1), 1e-6), 2e-7) << "size " << size;
      }
    }
  }
}

TEST(Tangent, of_the_linear_step_is_hookes_law) {
  Gradients random(2);
  const auto m = material(MaterialModel::linear_elastic);
  MaterialState<double> start;
  start.elastic = {1e4, 2e4, -1e4, 3e3, 0, 1e3};
  EXPECT_LT(worst_error(m, start, random.draw<double>(1e-3), random.draw<double>(1), 1e-4), 1e-9);
}

TEST(Tangent, is_symmetric) {
  Gradients random(3);
  for (const auto model : {MaterialModel::hencky, MaterialModel::corotated, MaterialModel::drucker_prager}) {
    const auto m = material(model);
    for (int n = 0; n < 50; ++n) {
      MaterialState<double> start;
      start.elastic = deviator(Sym3<double>{1e-3, -2e-3, 5e-4, 3e-4, -1e-4, 2e-4});
      start.log_volume = -2e-3;
      const M g = random.draw<double>(5e-3), u = random.draw<double>(1), v = random.draw<double>(1);
      PointTangent<double> t;
      nominal_stress(m, start, g, 0.01, &t);
      const double uv = inner(u, apply(t, v)), vu = inner(v, apply(t, u));
      EXPECT_NEAR(uv, vu, 1e-9 * norm(u) * norm(apply(t, v)));
    }
  }
}

TEST(Tangent, of_a_yielding_point_is_exact_but_for_the_pressure_in_its_friction) {
  Gradients random(4);
  auto m = material(MaterialModel::drucker_prager);
  int yielding = 0;
  for (int n = 0; n < 200; ++n) {
    m.apex = n < 100 ? 0 : 2e3;  // a sharp tip, a rounded one
    MaterialState<double> start;
    start.log_volume = -2e-3;
    const M g = random.draw<double>(3e-3);
    if (start.log_volume + log_volume_change(g) >= 0) continue;  // open: no stress, no stiffness
    const M direction = isochoric(random.draw<double>(1), g);    // which leaves the pressure alone
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
  Gradients random(5);
  for (const auto model : {MaterialModel::hencky, MaterialModel::corotated, MaterialModel::drucker_prager}) {
    const auto m = material(model);
    for (int n = 0; n < 50; ++n) {
      MaterialState<double> start;
      start.elastic = deviator(Sym3<double>{1e-3, -2e-3, 5e-4, 3e-4, -1e-4, 2e-4});
      start.log_volume = model == MaterialModel::drucker_prager ? -1e-3 : 0;
      const M g = random.draw<double>(4e-3);
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

template <class Real>
Material<Real> sand_at_yield(double dilatancy, double apex) {
  auto m = material<Real>(MaterialModel::drucker_prager, dilatancy);
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
  for (const double dilatancy : {0.0, 10.0})
    for (const double apex : {0.0, 100.0})
      EXPECT_LT(moved_by_rounding<double>(1e-14, dilatancy, apex), 1e-9) << dilatancy << " deg, apex " << apex;
  // In single precision strains of 1e-3 are rounded to 1e-7 of themselves, and stretches to 1e-4 of their gaps.
  EXPECT_LT(moved_by_rounding<float>(1e-7, 0, 100), 1e-2);
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
}  // namespace talus::testing
