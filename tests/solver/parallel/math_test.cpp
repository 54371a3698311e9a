// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors and matrices of three against their definitions, on random matrices (fixed seed) and at the awkward ones.
#include "solver/parallel/math.hpp"

#include <gtest/gtest.h>

#include <random>

namespace talus {
namespace {

class Matrices : public ::testing::Test {
 protected:
  double number() { return spread_(engine_); }
  Vec3<double> vector() { return {number(), number(), number()}; }
  Mat3<double> matrix() { return {vector(), vector(), vector()}; }
  Sym3<double> symmetric() { return {number(), number(), number(), number(), number(), number()}; }

 private:
  std::mt19937 engine_{20261121};
  std::uniform_real_distribution<double> spread_{-1, 1};
};

void expect_near(const Vec3<double>& a, const Vec3<double>& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST_F(Matrices, inverse_undoes_the_matrix) {
  for (int n = 0; n < 200; ++n) {
    const Mat3<double> m = matrix();
    if (std::abs(determinant(m)) < 0.05) continue;  // rounding grows with the condition: 1e-12 holds up to there
    const Vec3<double> v = vector();
    expect_near(inverted(m) * (m * v), v, 1e-12);
  }
}

TEST_F(Matrices, inverse_of_a_symmetric_matrix_undoes_it) {
  for (int n = 0; n < 200; ++n) {
    const Sym3<double> s = symmetric().plus_identity(4);  // diagonally dominant
    const Vec3<double> v = vector();
    expect_near(inverted(s) * (s * v), v, 1e-13);
  }
}

TEST_F(Matrices, determinant_changes_sign_with_two_columns_and_is_that_of_the_volume) {
  const Mat3<double> m = matrix();
  EXPECT_DOUBLE_EQ(determinant(Mat3<double>{m.b, m.a, m.c}), -determinant(m));
  EXPECT_NEAR(determinant(m), dot(m.a, cross(m.b, m.c)), 1e-15);
}

TEST_F(Matrices, outer_product_maps_a_vector_as_it_should) {
  Mat3<double> m{};
  const Vec3<double> v = vector(), g = vector(), x = vector();
  add_outer(m, v, g);
  expect_near(m * x, v * dot(g, x), 1e-15);
}

TEST_F(Matrices, eigenvectors_are_orthonormal_and_compose_the_matrix_again) {
  for (int n = 0; n < 200; ++n) {
    const Sym3<double> s = symmetric();
    double values[3];
    Mat3<double> n3;
    eigen_symmetric(s, values, n3);
    EXPECT_NEAR(dot(n3.a, n3.a), 1, 1e-14);
    EXPECT_NEAR(dot(n3.a, n3.b), 0, 1e-14);
    EXPECT_NEAR(dot(n3.b, n3.c), 0, 1e-14);
    const Sym3<double> again = compose(values, n3);
    EXPECT_LT(norm_squared(again + s * -1.0), 1e-27);
  }
}

// Two eigenvalues 1e-9 apart: closed forms by angles lose the vectors there, rotations do not.
TEST_F(Matrices, nearly_equal_eigenvalues_keep_their_vectors) {
  const double angle = 0.3, c = std::cos(angle), d = std::sin(angle);
  const double given[3] = {1, 1 + 1e-9, 3};
  const Sym3<double> s = compose(given, Mat3<double>{{c, d, 0}, {-d, c, 0}, {0, 0, 1}});
  double values[3];
  Mat3<double> n3;
  eigen_symmetric(s, values, n3);
  EXPECT_LT(norm_squared(compose(values, n3) + s * -1.0), 1e-29);
  std::sort(values, values + 3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(values[k], given[k], 1e-14);
}

TEST_F(Matrices, multiple_of_the_identity_has_no_outlying_eigenvector) {
  const Vec3<double> none = outlying_eigenvector(Sym3<double>{2, 2, 2, 0, 0, 0});
  EXPECT_EQ(dot(none, none), 0);
  const Vec3<double> z = outlying_eigenvector(Sym3<double>{1, 1, 5, 0, 0, 0});
  EXPECT_NEAR(std::abs(z.z), 1, 1e-7);  // good to the square root of rounding
}

TEST_F(Matrices, commuting_product_is_the_product_of_powers) {
  const Sym3<double> s = symmetric(), square = commuting_product(s, s), cube = commuting_product(square, s);
  const Vec3<double> v = vector();
  expect_near(cube * v, s * (s * (s * v)), 1e-14);
}

TEST_F(Matrices, deviator_has_no_trace_and_keeps_the_shear) {
  const Sym3<double> s = symmetric(), d = deviator(s);
  EXPECT_NEAR(trace(d), 0, 1e-15);
  EXPECT_EQ(d.xy, s.xy);
}

}  // namespace
}  // namespace talus
