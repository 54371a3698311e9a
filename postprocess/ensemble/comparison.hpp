// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Members compared with a survey as a whole: how probable it is, given each of their runs.
#pragma once

#include <functional>
#include <vector>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/fit_options.hpp"
#include "postprocess/ensemble/likelihood.hpp"
#include "postprocess/report/page.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// A footprint on another grid, as the share of each cell that it covers; where its grid ends, nothing.
std::vector<double> covered_shares(const Footprint& footprint, const MapGrid& from, const MapGrid& to);

/// What a thickness is called among what is compared.
inline constexpr const char* thickness_compared = "thickness of the deposit";

/// Standard deviation of the survey's error in each cell [m].
std::vector<double> deviation_of(const SurveyError& error, std::size_t cells);

class Comparison {
 public:
  /// What a survey gives of the members' runs: the deposit's thickness where it was measured and members keep theirs,
  /// otherwise its outline; the outline of the flow where it is no change of the surface; numbers of [calibrate].
  /// `deposit` [cells]: the surveyed one, NaN where members cannot be compared with it.
  Comparison(const EnsembleCounts& counts, const Survey& survey, const std::vector<double>& deposit,
             const CalibrateOptions& options, double deposit_threshold);

  /// Compares member k; `kept`: its deposit on the survey's grid, where it was kept. Different members may be compared
  /// at the same time.
  void compare(std::size_t k, const OnSurveyGrid* kept);

  bool any() const { return !kinds_.empty(); }
  /// [members] the logarithm of the likelihood, all kinds taken as independent; NaN: not compared.
  std::vector<double> logarithms() const;
  /// likelihood.json: the logarithms; of each kind what is compared, and how probable each discrepancy is after the
  /// survey. `drawn`: the members are draws after the survey; otherwise they are weighted by their likelihood.
  Json json(bool drawn) const;

 private:
  using Simulate = std::function<Simulated(std::size_t k, const OnSurveyGrid* kept)>;
  /// Numbers of one kind, and the members' likelihoods by them.
  struct Kind {
    Compared compared;
    double side;  ///< of a block [m]; 0: a single number
    Likelihood likelihood;
    Simulate simulate;
    std::vector<std::vector<double>> by_discrepancy;  ///< [members]; empty: not compared
  };
  void add(Compared compared, double side, Simulate simulate);
  void add_thickness(const std::vector<double>& deposit, const std::vector<char>& inside, double least);
  void add_outline(const char* name, const std::vector<double>& covered, const std::vector<Footprint>& footprints);
  void add_number(const CalibrateNumber& number);

  const EnsembleCounts& counts_;
  const Survey& survey_;
  std::vector<Kind> kinds_;
};

}  // namespace talus::postprocess
