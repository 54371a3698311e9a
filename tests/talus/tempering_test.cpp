// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Draws from posteriors of closed form.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "common/error.hpp"
#include "talus/tempering.hpp"

namespace talus::command {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Places prior_draws(std::size_t count, std::size_t keys, unsigned seed = 7) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Places places(count, std::vector<double>(keys));
  for (auto& place : places)
    for (double& one : place) one = normal(random);
  return places;
}

/// Measured numbers y = A z + noise of deviation s: the posterior of z is normal.
struct Linear {
  Eigen::MatrixXd a;
  Eigen::VectorXd y;
  double s;
  Eigen::MatrixXd covariance() const {
    return (a.transpose() * a / (s * s) + Eigen::MatrixXd::Identity(a.cols(), a.cols())).inverse();
  }
  Eigen::VectorXd mean() const { return covariance() * a.transpose() * y / (s * s); }
  double log_evidence() const {
    const Eigen::MatrixXd all = a * a.transpose() + s * s * Eigen::MatrixXd::Identity(a.rows(), a.rows());
    return -0.5 * (static_cast<double>(y.size()) * std::log(2 * std::numbers::pi) + std::log(all.determinant()) +
                   y.dot(all.inverse() * y));
  }
  LogLikelihoods model() const {
    return [this](const Places& places) {
      std::vector<double> found;
      for (const auto& place : places) {
        const Eigen::Map<const Eigen::VectorXd> z(place.data(), static_cast<Eigen::Index>(place.size()));
        found.push_back(-0.5 * (y - a * z).squaredNorm() / (s * s) -
                        static_cast<double>(y.size()) * std::log(s * std::sqrt(2 * std::numbers::pi)));
      }
      return found;
    };
  }
};

/// Mean and covariance of draws agree with the closed form within five sampling errors of half as many draws.
void expect_posterior(const Posterior& found, const Linear& of) {
  const auto n = static_cast<double>(found.places.size());
  const auto d = of.a.cols();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(d);
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(d, d);
  for (const auto& place : found.places) {
    const Eigen::Map<const Eigen::VectorXd> z(place.data(), d);
    mean += z / n;
    square += (z - of.mean()) * (z - of.mean()).transpose() / n;
  }
  const Eigen::MatrixXd exact = of.covariance();
  for (Eigen::Index i = 0; i < d; ++i) {
    EXPECT_NEAR(mean[i], of.mean()[i], 5 * std::sqrt(2 * exact(i, i) / n)) << i;
    EXPECT_NEAR(square(i, i) / exact(i, i), 1, 5 * std::sqrt(4 / n)) << i;
  }
  EXPECT_NEAR(found.log_evidence, of.log_evidence(), 0.3);
}

const Linear ridge{Eigen::MatrixXd{{1.0, 0.9}, {0.0, 0.02}}, Eigen::VectorXd{{1.5, 0.0}}, 0.05};
const Linear three{Eigen::MatrixXd{{1.0, 0.5, 0.1}, {-0.3, 1.0, 0.0}, {0.2, 0.0, 0.6}, {0.5, 0.5, 0.5}},
                   Eigen::VectorXd{{0.4, -0.9, 0.3, 0.2}}, 0.2};

TEST(Tempering, draws_the_posterior_of_a_linear_model) {
  for (const Linear* of : {&ridge, &three})
    expect_posterior(draw_posterior(prior_draws(2000, static_cast<std::size_t>(of->a.cols())), 3, {of->model()}), *of);
}

TEST(Tempering, finds_a_posterior_a_thousandth_as_wide_as_the_prior) {
  const Linear narrow{Eigen::MatrixXd{{1.0}}, Eigen::VectorXd{{2.0}}, 0.001};
  expect_posterior(draw_posterior(prior_draws(1000, 1), 3, {narrow.model()}), narrow);
}

TEST(Tempering, corrects_a_cheap_model_by_a_fine_one) {
  Linear shifted = three;
  shifted.y.array() += 0.15;
  shifted.a *= 1.1;
  std::size_t cheap = 0, fine = 0;
  const auto counted = [](const Linear& of, std::size_t& runs) {
    return [model = of.model(), &runs](const Places& places) {
      runs += places.size();
      return model(places);
    };
  };
  const Posterior found = draw_posterior(prior_draws(2000, 3), 3, {counted(shifted, cheap), counted(three, fine)});
  expect_posterior(found, three);
  EXPECT_LT(2 * fine, cheap);
  EXPECT_EQ(found.steps.front().model, 0u);
  EXPECT_EQ(found.steps.back().model, 1u);
}

TEST(Tempering, leaves_the_prior_where_the_likelihood_tells_nothing) {
  const auto flat = [](const Places& places) { return std::vector<double>(places.size(), -12.0); };
  const Posterior found = draw_posterior(prior_draws(1000, 2), 3, {flat});
  EXPECT_NEAR(found.log_evidence, -12, 1e-9);
  EXPECT_EQ(found.steps.size(), 1u);
  double square = 0;
  for (const auto& place : found.places) square += place[0] * place[0] / 1000;
  EXPECT_NEAR(square, 1, 0.25);
}

TEST(Tempering, passes_over_runs_that_failed_and_refuses_where_all_did) {
  const auto half = [](const Places& places) {
    std::vector<double> found;
    for (const auto& place : places) found.push_back(place[0] > 0 ? 0 : -infinity);
    return found;
  };
  const Posterior found = draw_posterior(prior_draws(1000, 1), 3, {half});
  for (const auto& place : found.places) EXPECT_GT(place[0], 0);
  EXPECT_NEAR(found.log_evidence, std::log(0.5), 0.1);
  const auto all = [](const Places& places) { return std::vector<double>(places.size(), -infinity); };
  EXPECT_THROW(draw_posterior(prior_draws(50, 1), 3, {all}), DataError);
}

TEST(Tempering, draws_the_same_again) {
  const auto first = draw_posterior(prior_draws(200, 3), 3, {three.model()});
  EXPECT_EQ(first.places, draw_posterior(prior_draws(200, 3), 3, {three.model()}).places);
  EXPECT_NE(first.places, draw_posterior(prior_draws(200, 3), 4, {three.model()}).places);
}

}  // namespace
}  // namespace talus::command
