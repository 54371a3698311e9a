// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/tempering.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "common/error.hpp"

namespace talus::command {
namespace {

constexpr double effective_share = 0.5;               // of the draws, from one exponent to the next
constexpr double unmoved = 0.5, unmoved_last = 0.05;  // share of the draws that a step may leave where they are
constexpr int most_sweeps = 12, cheap_sweeps = 4;
constexpr double good_acceptance = 0.3;

/// Weights from their logarithms, and the logarithm of their mean.
struct Weights {
  std::vector<double> values;  ///< their sum is one
  double log_mean = impossible;

  explicit Weights(const std::vector<double>& logarithms) {
    const double most = *std::ranges::max_element(logarithms);
    if (!std::isfinite(most)) return;
    for (const double one : logarithms) values.push_back(std::exp(one - most));
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    log_mean = most + std::log(sum / static_cast<double>(values.size()));
    for (double& value : values) value /= sum;
  }
  double effective() const {
    double squares = 0;
    for (const double value : values) squares += value * value;
    return squares > 0 ? 1 / squares : 0;
  }
};

class Tempering {
 public:
  Tempering(Places first, unsigned seed, const std::vector<LogLikelihoods>& models)
      : models_(models), random_(seed), places_(std::move(first)) {
    cheap_.assign(places_.size(), 0.0);
  }

  Posterior run() {
    for (std::size_t model = 0; model < models_.size(); ++model) {
      if (model > 0) cheap_ = own_;
      own_ = models_[model](places_);
      if (std::ranges::none_of(own_, [](double one) { return std::isfinite(one); }))
        throw DataError({"no run of the calibration has a likelihood", "all of them failed, or met nothing surveyed",
                         "Run the recipe alone first, and look at the ranges of [[ensemble.vary]]"});
      for (double exponent = 0; exponent < 1;) exponent = step(model, exponent);
    }
    result_.places = std::move(places_);
    result_.log_likelihoods = std::move(own_);
    return std::move(result_);
  }

 private:
  /// How much more probable the draws become by another power of this model's likelihood over the cheaper one's.
  std::vector<double> gains(double by) const {
    std::vector<double> logarithms;
    for (std::size_t k = 0; k < own_.size(); ++k)
      logarithms.push_back(std::isfinite(own_[k]) ? by * (own_[k] - cheap_[k]) : impossible);
    return logarithms;
  }

  double next_exponent(double exponent) const {
    const double wanted = effective_share * Weights(gains(0)).effective();
    if (Weights(gains(1 - exponent)).effective() >= wanted) return 1;
    double low = exponent, high = 1;
    constexpr int halvings = 60;
    for (int n = 0; n < halvings; ++n) {
      const double middle = (low + high) / 2;
      (Weights(gains(middle - exponent)).effective() < wanted ? high : low) = middle;
    }
    return low > exponent ? low : high;
  }

  double step(std::size_t model, double exponent) {
    const double next = next_exponent(exponent);
    const Weights weights(gains(next - exponent));
    result_.log_evidence += weights.log_mean;
    TemperingStep told{model, next, weights.effective(), 0, 0};
    resample(weights.values);
    spread();
    double still = 1;  // share of the draws that no sweep has moved
    while (told.sweeps < most_sweeps && still > (next < 1 ? unmoved : unmoved_last)) {
      const double accepted = model == 0 ? move(models_[0], next, own_) : move_by_cheaper(model, next);
      told.accepted += accepted;
      ++told.sweeps;
      still *= 1 - accepted;
    }
    told.accepted /= told.sweeps;
    result_.steps.push_back(told);
    return next;
  }

  /// Systematic resampling.
  void resample(const std::vector<double>& weights) {
    const std::size_t n = weights.size();
    const double start = uniform();
    std::vector<std::size_t> chosen;
    double below = 0;
    for (std::size_t k = 0; k < n; ++k) {
      below += weights[k] * static_cast<double>(n);
      while (chosen.size() < n && static_cast<double>(chosen.size()) + start < below) chosen.push_back(k);
    }
    while (chosen.size() < n) chosen.push_back(n - 1);
    const auto take = [&](auto& list) {
      auto taken = list;
      for (std::size_t k = 0; k < n; ++k) taken[k] = list[chosen[k]];
      list = std::move(taken);
    };
    take(places_);
    take(own_);
    take(cheap_);
  }

  /// Takes the root of the draws' covariance for the proposals.
  void spread() {
    const auto n = static_cast<Eigen::Index>(places_.size()), d = static_cast<Eigen::Index>(places_.front().size());
    Eigen::MatrixXd matrix(n, d);
    for (Eigen::Index k = 0; k < n; ++k)
      matrix.row(k) = Eigen::Map<const Eigen::RowVectorXd>(places_[static_cast<std::size_t>(k)].data(), d);
    matrix.rowwise() -= matrix.colwise().mean().eval();
    constexpr double least = 1e-12;  // so that draws of one place can move
    const Eigen::MatrixXd covariance =
        matrix.transpose() * matrix / static_cast<double>(n) + least * Eigen::MatrixXd::Identity(d, d);
    root_ = covariance.llt().matrixL();
    scale_ = 2.38 / std::sqrt(static_cast<double>(d));
  }

  double uniform() { return std::uniform_real_distribution<double>()(random_); }
  double log_uniform() { return std::log(1 - uniform()); }

  std::vector<double> proposal(const std::vector<double>& from) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd step(root_.rows());
    for (double& one : step) one = normal(random_);
    step = scale_ * (root_ * step);
    std::vector<double> place = from;
    for (std::size_t n = 0; n < place.size(); ++n) place[n] += step[static_cast<Eigen::Index>(n)];
    return place;
  }

  static double log_prior(const std::vector<double>& place) {
    return -0.5 * std::inner_product(place.begin(), place.end(), place.begin(), 0.0);
  }

  /// A Metropolis step of every draw towards prior times a power of this likelihood; the share that was accepted.
  double move(const LogLikelihoods& model, double exponent, std::vector<double>& likelihoods) {
    Places proposed;
    for (const auto& place : places_) proposed.push_back(proposal(place));
    const std::vector<double> found = model(proposed);
    std::size_t accepted = 0;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double now = log_prior(places_[k]) + exponent * likelihoods[k];
      if (!std::isfinite(found[k]) || log_uniform() >= log_prior(proposed[k]) + exponent * found[k] - now) {
        proposed[k].clear();
        continue;
      }
      places_[k] = std::move(proposed[k]);
      likelihoods[k] = found[k];
      ++accepted;
    }
    const double share = static_cast<double>(accepted) / static_cast<double>(places_.size());
    scale_ *= std::exp(share - good_acceptance);
    return share;
  }

  /// The same with the ends of chains on the cheaper model as proposals.
  double move_by_cheaper(std::size_t model, double exponent) {
    const Places before = places_;
    const std::vector<double> cheap_before = cheap_;
    for (int n = 0; n < cheap_sweeps; ++n) move(models_[model - 1], 1, cheap_);
    const std::vector<double> found = models_[model](places_);
    std::size_t accepted = 0;
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const double gain = exponent * ((found[k] - cheap_[k]) - (own_[k] - cheap_before[k]));
      if (places_[k] == before[k]) continue;
      if (!std::isfinite(found[k]) || log_uniform() >= gain) {
        places_[k] = before[k];
        cheap_[k] = cheap_before[k];
        continue;
      }
      own_[k] = found[k];
      ++accepted;
    }
    return static_cast<double>(accepted) / static_cast<double>(places_.size());
  }

  const std::vector<LogLikelihoods>& models_;
  std::mt19937_64 random_;
  Places places_;
  std::vector<double> own_, cheap_;  ///< logarithms of this model's likelihoods and of the one's before, 0 of none
  Eigen::MatrixXd root_;
  double scale_ = 1;
  Posterior result_;
};

}  // namespace

Posterior draw_posterior(Places first, unsigned seed, const std::vector<LogLikelihoods>& models) {
  return Tempering(std::move(first), seed, models).run();
}

}  // namespace talus::command
