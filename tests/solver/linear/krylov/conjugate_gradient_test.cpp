// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Conjugate gradients on small matrices: solution, limits, negative curvature.
#include "solver/linear/krylov/conjugate_gradient.hpp"

#include <gtest/gtest.h>

#include <random>

namespace talus::testing {
namespace {

using Vector = NodeVector<CpuDevice>;

/// Leaves a product as add_product() made it.
struct NothingToClose {
  void operator()(int) const {}
};

/// A full matrix over the nodes' components.
class DenseMatrix {
 public:
  explicit DenseMatrix(int nodes) : size_(3 * static_cast<std::size_t>(nodes)), entries_(size_ * size_) {}

  double& at(std::size_t row, std::size_t column) { return entries_[row * size_ + column]; }
  std::size_t size() const { return size_; }

  void add_product(const Vector& x, Vector& y, const int*) const {
    const auto* from = reinterpret_cast<const double*>(x.data());
    auto* to = reinterpret_cast<double*>(y.data());
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t j = 0; j < size_; ++j) to[i] += entries_[i * size_ + j] * from[j];
  }
  NothingToClose closing(const Vector&, Vector&) const { return {}; }

 private:
  std::size_t size_;
  std::vector<double> entries_;
};
static_assert(LinearOperator<DenseMatrix, CpuDevice>);

/// The diagonal of a matrix as preconditioner.
class Diagonal {
 public:
  explicit Diagonal(DenseMatrix& a) : inverse_(a.size()) {
    for (std::size_t i = 0; i < a.size(); ++i) inverse_[i] = 1 / a.at(i, i);
  }
  void apply(const Vector& r, Vector& z, CgState* state) {
    const auto* from = reinterpret_cast<const double*>(r.data());
    auto* to = reinterpret_cast<double*>(z.data());
    double r_z = 0;
    for (std::size_t i = 0; i < inverse_.size(); ++i) {
      to[i] = inverse_[i] * from[i];
      r_z += from[i] * to[i];
    }
    detail::FinishAngle{state}(&r_z);
  }
  void apply_after(const detail::StepAlong& step, const Vector& r, Vector& z, CgState* state) {
    if (state->halt != CgState::no) return;
    double r_r = 0;
    for (int n = 0; n < static_cast<int>(r.size()); ++n) r_r += step(n);
    state->take_residual(r_r);
    apply(r, z, state);
  }

 private:
  std::vector<double> inverse_;
};
static_assert(LinearPreconditioner<Diagonal, CpuDevice>);

std::vector<Vec3<double>> random_vectors(int count, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Vec3<double>> v(static_cast<std::size_t>(count));
  for (auto& x : v) x = {u(engine), u(engine), u(engine)};
  return v;
}

double distance(const Vector& a, const std::vector<Vec3<double>>& b) {
  double apart = 0, size = 0;
  const auto values = a.download();
  for (std::size_t n = 0; n < values.size(); ++n) {
    apart += dot(values[n] - b[n], values[n] - b[n]);
    size += dot(b[n], b[n]);
  }
  return std::sqrt(apart / size);
}

/// Random and symmetric, with a heavy diagonal that grows.
DenseMatrix random_matrix(int nodes) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> u(-1, 1);
  DenseMatrix a(nodes);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      const double entry = u(engine) / std::sqrt(static_cast<double>(a.size()));
      a.at(i, j) = j < i ? a.at(j, i) : entry;
    }
  }
  for (std::size_t i = 0; i < a.size(); ++i) a.at(i, i) += 2.5 + 0.01 * static_cast<double>(i);
  return a;
}

class SmallSystem : public ::testing::Test {
 protected:
  static constexpr int nodes = 60;

  /// Solves A x = A `expected`.
  LinearReport solve(DenseMatrix& a, const std::vector<Vec3<double>>& expected, const KrylovLimits& limits) {
    Vector of(device);
    of.upload(expected);
    b.resize(of.size());
    b.fill_zero();
    a.add_product(of, b, nullptr);
    return method.solve(a, Diagonal(a), b, x, limits);
  }

  CpuDevice device = CpuDevice::make();
  ConjugateGradient<CpuDevice> method{device};
  Vector b{device}, x{device};
};

TEST_F(SmallSystem, is_solved) {
  DenseMatrix a = random_matrix(nodes);
  const auto expected = random_vectors(nodes, 4);
  const LinearReport report = solve(a, expected, {.tolerance = 1e-12, .iterations = 500});
  EXPECT_TRUE(report.converged);
  EXPECT_FALSE(report.indefinite);
  EXPECT_LE(report.residual, 1e-12);
  EXPECT_GT(report.iterations, 2);
  EXPECT_LT(report.iterations, 200);
  EXPECT_LT(distance(x, expected), 1e-11);
}

TEST_F(SmallSystem, ends_without_a_solution_where_it_is_told_to) {
  DenseMatrix a = random_matrix(nodes);
  static int asked;  // what is asked holds no state of its own
  asked = 0;
  const LinearReport report = solve(a, random_vectors(nodes, 4),
                                    {.tolerance = 1e-12, .iterations = 500, .give_up = [] { return ++asked > 2; }});
  EXPECT_FALSE(report.converged);
  EXPECT_FALSE(report.indefinite);
  EXPECT_LE(report.iterations, 4);
}

TEST_F(SmallSystem, reports_that_it_ran_out_of_iterations) {
  DenseMatrix a = random_matrix(nodes);
  const LinearReport report = solve(a, random_vectors(nodes, 4), {.tolerance = 1e-12, .iterations = 2});
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_GT(report.residual, 1e-12);
}

TEST_F(SmallSystem, takes_a_right_hand_side_of_nothing) {
  DenseMatrix a = random_matrix(nodes);
  const std::vector<Vec3<double>> nothing(static_cast<std::size_t>(nodes));
  const LinearReport report = solve(a, nothing, {.tolerance = 1e-12, .iterations = 2});
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  for (const auto& v : x.download()) EXPECT_EQ(dot(v, v), 0);
}

TEST_F(SmallSystem, ends_a_diagonal_system_at_once) {
  DenseMatrix a(nodes);
  for (std::size_t i = 0; i < a.size(); ++i) a.at(i, i) = 1 + static_cast<double>(i);
  const LinearReport report = solve(a, random_vectors(nodes, 6), {.tolerance = 1e-12, .iterations = 500});
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 1);
}

TEST(ConjugateGradient, reports_a_direction_of_negative_curvature) {
  DenseMatrix a(2);
  for (std::size_t i = 0; i < a.size(); ++i) a.at(i, i) = i == 4 ? -1 : 1;
  const CpuDevice device = CpuDevice::make();
  Vector b(device), x(device);
  b.upload({{0, 0, 0}, {0, 1, 0}});
  ConjugateGradient<CpuDevice> method(device);
  DenseMatrix identity(2);
  for (std::size_t i = 0; i < identity.size(); ++i) identity.at(i, i) = 1;
  const LinearReport report = method.solve(a, Diagonal(identity), b, x, {});
  EXPECT_TRUE(report.indefinite);
  EXPECT_FALSE(report.converged);
}

TEST(CgState, halts_at_once_without_a_right_hand_side) {
  CgState state;
  state.begin(0);
  EXPECT_EQ(state.halt, CgState::converged);
  CgState nan;
  nan.begin(std::nan(""));
  EXPECT_EQ(nan.halt, CgState::spent);
}

TEST(CgState, halts_where_the_residual_is_small_enough_or_iterations_run_out) {
  CgState state;
  state.tolerance = 1e-3;
  state.most = 3;
  state.begin(4);
  state.take_residual(1);
  EXPECT_EQ(state.halt, CgState::no);
  CgState near = state;
  near.take_residual(4e-6);
  EXPECT_EQ(near.halt, CgState::converged);
  state.take_residual(1);
  state.take_residual(1);
  EXPECT_EQ(state.halt, CgState::spent);
  EXPECT_EQ(state.iterations, 3);
}

TEST(CgState, halts_where_the_curvature_is_not_positive) {
  CgState state;
  state.begin(1);
  detail::FinishCurvature finish{&state};
  const double negative = -1, positive = 1;
  finish(&negative);
  EXPECT_EQ(state.halt, CgState::indefinite);
  finish(&positive);
  EXPECT_EQ(state.curvature, -1) << "what comes after the end changes nothing";
}

TEST(CgState, begins_with_the_first_direction_as_it_is) {
  CgState state;
  state.begin(1);
  state.take_angle(2);
  EXPECT_EQ(state.turn, 0);
  state.most = 10;
  state.take_residual(0.5);
  state.take_angle(1);
  EXPECT_EQ(state.turn, 0.5);
}

TEST(StepAlong, moves_the_solution_and_takes_from_the_residual) {
  CgState state;
  state.angle = 2;
  state.curvature = 4;
  const Vec3<double> p{1, 0, 0}, ap{2, 2, 0};
  Vec3<double> x{1, 1, 1}, r{3, 0, 4};
  EXPECT_DOUBLE_EQ((detail::StepAlong{&state, &p, &ap, &x, &r}(0)), 4 + 1 + 16);
  EXPECT_EQ(x.x, 1.5);
  EXPECT_EQ(r.y, -1);
}

}  // namespace
}  // namespace talus::testing
