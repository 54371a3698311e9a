// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How probable a survey is, given the run of a member: its error, and a discrepancy of the model that is estimated.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace talus::postprocess {

/// Numbers of one kind that were surveyed.
struct Compared {
  std::string name, unit;                     ///< "thickness", "m"
  std::vector<double> surveyed;               ///< [n]
  std::vector<std::array<double, 2>> places;  ///< [n] on the map [m]; empty: the numbers have no place
  std::vector<double> error;                  ///< covariance of the survey's errors [n * n]
  double scale = 0;                           ///< their usual size, in whose multiples the discrepancy is sought
  double shortest = 0, longest = 0;           ///< between which its correlation length is sought [m]
};

/// The size and the correlation length of a discrepancy.
struct Discrepancy {
  double deviation = 0;  ///< [unit]
  double length = 0;     ///< [m]; 0: independent from number to number
};

/// What a run gives in the place of surveyed numbers, and how it would change as a whole.
struct Simulated {
  std::vector<double> numbers;             ///< [n]; empty: nothing
  std::vector<std::vector<double>> modes;  ///< [n] each, of any size: the numbers themselves, their slopes on the map
};

/// A normal likelihood: surveyed - simulated has the covariance E + s^2 (K + c^2 M), where E is the survey's error and
/// the rest the discrepancy of the model (Kennedy and O'Hagan 2001, eq. 4): K = exp(-distance / length), and M is the
/// sum of u u^T over the modes u of the run, brought to the usual size. The modes stand for a mass that is too thick or
/// lies elsewhere as a whole; without them a discrepancy that is alike over the deposit is taken for an effect of the
/// keys. They are those of the run, for those of the survey would favour thin runs (Peelle's puzzle: D'Agostini 1994).
/// Neither s nor the length is known: the likelihood is the mean over both, whose logarithms are uniform a priori, on a
/// fixed table of values.
class Likelihood {
 public:
  /// Throws std::logic_error where the sizes do not agree.
  explicit Likelihood(const Compared& compared);
  ~Likelihood();
  Likelihood(Likelihood&&) noexcept;

  /// The values of the table, all equally probable before the survey.
  const std::vector<Discrepancy>& table() const;
  /// The logarithm of the survey's density given the discrepancy, for each value of the table.
  std::vector<double> by_discrepancy(const Simulated& simulated) const;

 private:
  struct Table;
  std::unique_ptr<Table> table_;
};

/// log(mean(exp(values))); -infinity where all values are.
double log_mean(std::span<const double> values);

}  // namespace talus::postprocess
