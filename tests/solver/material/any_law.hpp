// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every constitutive law must hold, whatever it is: checked over a list of laws.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "solver/material/tangent.hpp"

namespace talus::testing {

class RandomGradient {
 public:
  explicit RandomGradient(unsigned seed) : engine_(seed) {}
  Vec3<double> vector(double size) { return {size * u_(engine_), size * u_(engine_), size * u_(engine_)}; }
  Mat3<double> operator()(double size) { return {vector(size), vector(size), vector(size)}; }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> u_{-1, 1};
};

inline Mat3<double> sum(const Mat3<double>& a, const Mat3<double>& b, double t) {
  return {a.a + b.a * t, a.b + b.b * t, a.c + b.c * t};
}
inline double norm(const Mat3<double>& a) { return std::sqrt(dot(a.a, a.a) + dot(a.b, a.b) + dot(a.c, a.c)); }

/// A material of this law with the law's own defaults, E = 10 MPa and Poisson's ratio 0.25.
template <class Law, class Laws>
Material<double, Laws> some_material() {
  Material<double, Laws> m;
  m.model = model_of<Law, Laws>;
  m.density = 2000;
  m.shear_modulus = 4e6;
  m.bulk_modulus = 2e7 / 3;
  m.wave_speed = std::sqrt((m.bulk_modulus + 4 * m.shear_modulus / 3) / m.density);
  m.template numbers_of<Law>() = Law::template numbers<double>(typename Law::Options{}, 1.0);
  prepare_for_newton(m, 0.0);
  return m;
}

/// Some compressed and sheared state that the law itself has led to.
template <class Laws>
MaterialState<double> some_state(const Material<double, Laws>& m, RandomGradient& random) {
  MaterialState<double> s;
  Mat3<double> g = random(1e-3);
  g.a.x -= 2e-3;
  g.b.y -= 2e-3;
  g.c.z -= 2e-3;
  advance_material(m, g, 0.01, s);
  return s;
}

template <class Law, class Laws>
void expect_name_options_and_words(std::set<std::string>& names, std::set<std::string>& keys) {
  EXPECT_FALSE(Law::name.empty());
  EXPECT_TRUE(names.insert(std::string(Law::name)).second) << "two laws are called " << Law::name;
  typename Law::Options options;
  recipe::Defaults own;
  const LawTable table{.name = "[solve.material]", .chosen = Law::name};
  options.describe(*recipe::make_collector("law", own), table);
  for (const auto& [key, value] : own) EXPECT_TRUE(keys.insert(key).second) << key << " belongs to two laws";
  std::vector<Fault> faults;
  options.describe(*recipe::make_checker(faults), table);
  EXPECT_TRUE(faults.empty()) << "the defaults are refused";
  EXPECT_NE(Law::words(options, "ELASTICITY").find("ELASTICITY"), std::string::npos);
  EXPECT_FALSE(Law::sentence(options).empty());
  EXPECT_EQ(visit_law<Laws>(model_of<Law, Laws>, [](auto law) { return std::string(law.name); }), Law::name);
}

template <class Laws>
void expect_finite_energy_that_rest_has_not(const Material<double, Laws>& m) {
  RandomGradient random(11);
  EXPECT_EQ(elastic_energy(m, {}), 0);
  EXPECT_EQ(norm_squared(kirchhoff_stress(m, {})), 0);
  for (int n = 0; n < 20; ++n) {
    const double energy = elastic_energy(m, some_state(m, random));
    EXPECT_TRUE(std::isfinite(energy));
    EXPECT_GT(energy, 0);
  }
}

/// The gradient less what changes the volume, or the stress less its pressure.
inline Mat3<double> without_trace(Mat3<double> g) {
  const double third = (g.a.x + g.b.y + g.c.z) / 3;
  g.a.x -= third;
  g.b.y -= third;
  g.c.z -= third;
  return g;
}

/// The change of a gradient g of this size that leaves the volume alone: dl = dG F^-1 without trace.
inline Mat3<double> isochoric(const Mat3<double>& change, const Mat3<double>& g) {
  const Mat3<double> f{{g.a.x + 1, g.a.y, g.a.z}, {g.b.x, g.b.y + 1, g.b.z}, {g.c.x, g.c.y, g.c.z + 1}};
  const Mat3<double> l = without_trace({change * inverted(f).a, change * inverted(f).b, change * inverted(f).c});
  return {l * f.a, l * f.b, l * f.c};
}

/// The derivative of the nominal stress against central differences, whose step of 1e-8 leaves an error of 1e-6. The
/// tangent of sand holds its yield stress: it is the derivative where the volume stays.
template <class Laws>
void expect_tangent_to_be_the_derivative(const Material<double, Laws>& m) {
  RandomGradient random(12);
  const bool freezes = visit_law<Laws>(m.model, [](auto law) { return std::is_same_v<decltype(law), DruckerPrager>; });
  for (int n = 0; n < 50; ++n) {
    const MaterialState<double> start = some_state(m, random);
    const Mat3<double> g = random(1e-3), any = random(1), direction = freezes ? isochoric(any, g) : any;
    constexpr double dt = 0.01, step = 1e-8;
    PointTangent<double> tangent;
    nominal_stress(m, start, g, dt, &tangent);
    const Mat3<double> exact = apply(tangent, direction);
    const auto at = [&](double t) { return nominal_stress<double>(m, start, sum(g, direction, t), dt, nullptr); };
    Mat3<double> difference = sum(at(step), at(-step), -1);
    difference = {difference.a * (0.5 / step), difference.b * (0.5 / step), difference.c * (0.5 / step)};
    EXPECT_LT(norm(sum(difference, exact, -1)), 2e-5 * norm(exact));
  }
}

/// Every law of the list has a name, options, words, a finite energy, and a tangent that is its stress's derivative.
template <class Laws>
void expect_laws_to_hold() {
  std::set<std::string> names, keys;
  Laws::each([&](auto law) {
    using Law = decltype(law);
    const ::testing::ScopedTrace trace(__FILE__, __LINE__, std::string(Law::name));
    expect_name_options_and_words<Law, Laws>(names, keys);
    const auto m = some_material<Law, Laws>();
    expect_finite_energy_that_rest_has_not(m);
    expect_tangent_to_be_the_derivative(m);
  });
  EXPECT_EQ(names.size(), static_cast<std::size_t>(Laws::count));
}

}  // namespace talus::testing
