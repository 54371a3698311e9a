// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The search for the values of one or two keys with which a run agrees best with the survey.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace talus::command {

/// What a run of a fit scored; NaN: it has no such score.
struct FitScore {
  double runout = std::numeric_limits<double>::quiet_NaN();             ///< simulated [m]
  double runout_difference = std::numeric_limits<double>::quiet_NaN();  ///< simulated less surveyed [m]
  double overlap = std::numeric_limits<double>::quiet_NaN();            ///< CSI of the deposit, or of the footprint
  double thickness_error = std::numeric_limits<double>::quiet_NaN();    ///< RMSE of the deposit's thickness [m]

  /// The difference of the run-outs over the survey's [-].
  double runout_share() const { return runout_difference / (runout - runout_difference); }
};

/// A run whose run-out differs by a larger share of the survey's is not taken for its overlap [-].
inline constexpr double most_runout_share = 0.1;

struct FitRun {
  std::vector<double> values;  ///< of the keys
  FitScore score;
};

struct FitKey {
  std::string name;  ///< "solve.base.friction_angle_deg"
  double start = 0, low = 0, high = 0;
};

struct FitProblem {
  std::vector<FitKey> keys;  ///< one or two
  int runs = 16;             ///< at most
};

using MakeFitRun = std::function<FitScore(const std::vector<double>& values)>;

/// The runs of a search, in their order. First the run-out: the first key is changed by factors of 1.25 until the
/// difference changes its sign, and this interval is bisected until the difference is a hundredth of the survey's
/// run-out or the ends a hundredth of their value apart, with at most half of the runs. Then the overlap: of one
/// key by golden sections (Kiefer 1953) around the best run so far until its neighbours are 3 % away, of two by COBYLA
/// (Powell 1994) from the run of the smallest difference. Values have four digits. Keys whose bounds are positive are
/// searched on a scale of logarithms.
std::vector<FitRun> search(const FitProblem& problem, const MakeFitRun& make);

/// The place of the best run: of those whose run-out fits (most_runout_share; of all where none does) the largest
/// overlap; of those within 0.005 of it the smallest error of thickness; without any overlap the smallest difference of
/// the run-outs. Throws std::logic_error where there is no run.
std::size_t best_of(const std::vector<FitRun>& runs);

/// Where the run-out of runs of one key, which differ in that key alone, changes most.
struct Steepest {
  double low = 0, high = 0;                ///< neighbouring values of the key
  double runout_low = 0, runout_high = 0;  ///< [m]
  double elasticity = 0;  ///< change of the run-out's logarithm over that of the value's [-]; of steps of a fiftieth on
};
Steepest steepest_of(const std::vector<FitRun>& runs);

}  // namespace talus::command
