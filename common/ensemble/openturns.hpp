// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What ensembles take of OpenTURNS. It and the forty libraries below it take as long to load as all others together, so
// that a module of its own (openturns_module.cpp) is loaded with them where a first distribution is asked for.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/ensemble/options.hpp"

namespace talus::openturns {

class Law {
 public:
  virtual ~Law() = default;
  virtual double below(double value) const = 0;    ///< the share that lies at this value and below it
  virtual double density(double value) const = 0;  ///< of a discrete one the share of this value
  virtual double quantile(double share) const = 0;
  virtual double mean() const = 0;
  virtual double deviation() const = 0;
  /// What is left of it between two values, one of which may be open.
  virtual std::shared_ptr<const Law> between(std::optional<double> low, std::optional<double> high) const = 0;
};
using AnyLaw = std::shared_ptr<const Law>;

/// A part of a density that is linear between values.
struct Triangle {
  double from, top, to;
  double share;  ///< of the whole
};

/// Spearman's, of the keys at two places.
struct RankCorrelation {
  std::size_t first, second;
  double value;
};

class Copula {
 public:
  virtual ~Copula() = default;
  /// Independent shares 0 < u < 1 made to go together by conditional quantiles (Rosenblatt 1952); the first one stays.
  virtual void bind(std::vector<double>& shares) const = 0;
};

/// Sobol indices of each input with their 95 % intervals.
struct SobolIndices {
  std::vector<double> first, first_low, first_high;
  std::vector<double> total, total_low, total_high;
};

/// How far an output depends on an input, in whatever form.
struct Dependence {
  double r2 = 0;      ///< normalised HSIC: 0 independent, 1 at most
  double chance = 1;  ///< p-value of independence
};

using Lists = std::vector<std::vector<double>>;

/// Where the largest value of a function is looked for.
struct Region {
  std::vector<double> from;       ///< the first place
  std::vector<double> low, high;  ///< bounds of each coordinate
  double radius = 1;              ///< of the first steps, in every coordinate
  int most_calls = 0;             ///< of the function
};

class Library {
 public:
  virtual ~Library() = default;
  virtual AnyLaw uniform(double low, double high) const = 0;
  virtual AnyLaw normal(double mean, double deviation) const = 0;
  virtual AnyLaw lognormal(double mean, double deviation) const = 0;
  virtual AnyLaw triangular(double low, double mode, double high) const = 0;
  virtual AnyLaw beta(double mean, double deviation, double low, double high) const = 0;
  virtual AnyLaw triangles(const std::vector<Triangle>& parts) const = 0;
  /// Places 0, 1, ... with shares that sum to one.
  virtual AnyLaw places(const std::vector<double>& shares) const = 0;

  /// Nothing where no such correlations can be together: the matrix of ranks or of normals is not positive definite.
  virtual std::shared_ptr<const Copula> copula(std::size_t keys, const std::vector<RankCorrelation>& ranks) const = 0;

  /// `count` members in the unit cube of the keys; with Design::sensitivity count (keys + 2) of them.
  virtual Lists draw(Design design, std::size_t count, std::size_t keys, unsigned long seed) const = 0;

  /// By Saltelli's estimators (2002, equations 14 and 18). `inputs`: a list of [size (d + 2)] values for each of d
  /// inputs, whose rows are sample A, sample B, and for each input A with its values of B. `outputs` likewise.
  virtual SobolIndices sobol_indices(const Lists& inputs, const std::vector<double>& outputs,
                                     std::size_t size) const = 0;
  /// Spearman's rank correlation of each input with the output.
  virtual std::vector<double> rank_correlations(const Lists& inputs, const std::vector<double>& outputs) const = 0;
  /// Standardised coefficients of a linear regression of the output's ranks on the inputs'. Empty where inputs depend
  /// linearly.
  virtual std::vector<double> rank_regression(const Lists& inputs, const std::vector<double>& outputs) const = 0;

  /// Of each input: the Hilbert-Schmidt independence criterion of the ranks with Gaussian kernels as wide as their
  /// deviation (Gretton et al. 2005; R2-HSIC of Da Veiga 2015), and its asymptotic p-value. Takes size^2 of memory.
  /// Empty where that has none: of few values, or of values most of which are the same.
  virtual std::vector<Dependence> hsic(const Lists& inputs, const std::vector<double>& outputs) const = 0;

  /// Looks for the largest value of a function of two coordinates or more by COBYLA (Powell 1994), which asks for no
  /// derivative; the steps end at a tenth of the radius. What the function throws is thrown again.
  virtual void maximise(const std::function<double(const std::vector<double>&)>& function,
                        const Region& region) const = 0;
};

/// Loads the module at the first call. Throws DataError where it or a library below it is missing.
const Library& library();

}  // namespace talus::openturns
