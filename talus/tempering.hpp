// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Draws from a posterior by sequential Monte Carlo over tempered likelihoods, many runs of the model at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace talus::command {

/// Places in the space of independent standard normal variables: the prior.
using Places = std::vector<std::vector<double>>;

/// The logarithm of the likelihood of a run that failed.
inline constexpr double impossible = -std::numeric_limits<double>::infinity();

/// The logarithms of the likelihood at places; `impossible` where a run failed.
using LogLikelihoods = std::function<std::vector<double>(const Places& places)>;

/// One step from one tempered likelihood to the next.
struct TemperingStep {
  std::size_t model = 0;  ///< 0: the cheapest
  double exponent = 0;    ///< of its likelihood, after the step
  double effective = 0;   ///< independent draws that the weighted ones stand for
  int sweeps = 0;         ///< Metropolis moves of each draw
  double accepted = 0;    ///< share of the proposals
};

struct Posterior {
  Places places;                        ///< equally probable
  std::vector<double> log_likelihoods;  ///< of the last model
  std::vector<TemperingStep> steps;
  double log_evidence = 0;  ///< logarithm of the likelihood's mean over the prior
};

/// Draws from prior times likelihood: draws of the prior are weighted by a power of the likelihood that leaves half of
/// them effective, resampled, and moved by Metropolis steps, until the power is 1 (Del Moral, Doucet and Jasra 2006;
/// Ching and Chen 2007). Proposals have the draws' covariance; a step moves until half of the draws have moved, the
/// last one until nineteen twentieths have. Of two models the first one, cheap, is treated so; the power then leads
/// from its likelihood to the second one's, whose proposals are the ends of chains on the first
/// (delayed acceptance: Christen and Fox 2005). `first`: draws of the prior. Throws DataError where no run has a
/// likelihood.
Posterior draw_posterior(Places first, unsigned seed, const std::vector<LogLikelihoods>& models);

}  // namespace talus::command
