// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far two maps agree: areas of yes and no, errors of thickness.
#pragma once

#include <cstddef>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// Areas [m2] where simulation and survey say yes or no. Cells with NaN in either are not compared.
struct Contingency {
  double true_positive = 0;   ///< both yes
  double false_positive = 0;  ///< simulation only
  double false_negative = 0;  ///< survey only
  double true_negative = 0;   ///< both no

  /// Critical success index (threat score, intersection over union): TP / (TP + FP + FN). NaN where neither says yes.
  double csi() const;
  /// Share of the surveyed area that was hit: TP / (TP + FN).
  double hit_rate() const;
  /// Share of the simulated area that is false: FP / (TP + FP).
  double false_alarm_ratio() const;
  /// Heidke skill score: agreement beyond chance, 1 = perfect, 0 = chance (Heidke 1926).
  double hss() const;
  /// Distance to perfect classification, sqrt((1 - TPR)^2 + FPR^2) (Formetta et al. 2016; r.avaflow's D2PC).
  double d2pc() const;
  /// Factor of conservativeness: simulated over surveyed area, (TP + FP) / (TP + FN) (r.avaflow's FoC).
  double foc() const;
  /// Synthetic performance index of r.avaflow (2.3, evaluation scores), 1 = perfect, 0 = nothing right: the mean of
  /// CSI, HSS, 1 - D2PC, sin^5(pi/2 min(FoC, 1/FoC)) and sin^5(pi/2 min(R, 1/R)), each not below 0, where R is the
  /// simulated run-out along the thalweg over the surveyed one. As there, HSS and D2PC are taken with TN = 5 (TP + FN)
  /// - FP, so that the extent of the map has no part in it. NaN where the survey has no area or R is not positive.
  double spi(double runout_ratio) const;
};

/// Yes is a value above the threshold. Both vectors on the same grid; `cell_area` in m2.
Contingency compare(const std::vector<double>& simulated, double simulated_threshold,
                    const std::vector<double>& surveyed, double surveyed_threshold, double cell_area);

/// Mean of (share - surveyed)^2 over the cells where either is not 0, surveyed being 1 above `threshold` and else 0: 0
/// = perfect, 1 = wrong throughout (Brier 1950). Cells with NaN in either are left out; NaN where there is no cell.
double brier_score(const std::vector<double>& share, const std::vector<double>& surveyed, double threshold);

/// Difference simulated - surveyed over the cells where either exceeds the threshold [m]; NaN where none does.
struct ThicknessError {
  double rmse = 0, bias = 0, mean_absolute = 0;
  double median = 0;
  double nmad = 0;  ///< 1.4826 median(|d - median(d)|): the spread of the bulk of the cells (Hoehle and Hoehle 2009)
};
/// Errors of a simulated thickness against a surveyed one.
ThicknessError thickness_error(const std::vector<double>& simulated, const std::vector<double>& surveyed,
                               double threshold);

/// Area under the receiver operating characteristic curve: the chance that a cell the survey says yes to (above
/// `threshold`) has the larger simulated value than one it says no to, ties counting half (Mann and Whitney 1947;
/// Fawcett 2006). 1 = perfect, 0.5 = chance. Over all thresholds of the simulation, unlike that of r.avaflow, which
/// takes one. Cells with NaN on either side are left out; NaN where the survey says the same everywhere.
double auroc(const std::vector<double>& simulated, const std::vector<double>& surveyed, double threshold);

/// The normalised residual r = (simulated - surveyed) / sigma over some cells. NaN where there is no cell.
struct Residual {
  std::size_t cells = 0;
  double median = 0;
  double within = 0;       ///< share of the cells with |r| <= 1.96; 0.95 where the survey's error is all there is
  double chi_squared = 0;  ///< mean of r^2: 1 where the survey's error is all there is (no parameter is fitted)
};

/// Over the cells where `counts` holds and sigma is positive; a NaN in any of the three leaves a cell out.
Residual residual_of(const std::vector<double>& simulated, const std::vector<double>& surveyed,
                     const std::vector<double>& sigma, const std::vector<char>& counts);

/// How far two deposits differ, on the first one's grid.
struct DepositDifference {
  Raster difference;   ///< second less first, vertical [m]; NaN where both are outside
  double larger = 0;   ///< largest gain [m]
  double smaller = 0;  ///< largest loss, as a positive number [m]
  double p99 = 0;      ///< 99 % of the cells where either is thicker than the threshold differ by less [m]
  double volume = 0;   ///< of the second less that of the first [m3]
  double moved = 0;    ///< share of the first deposit that lies elsewhere in the second, volumes set equal [-]
  double overlap = 0;  ///< area of both over area of either, where thicker than the threshold [-]
  double rms = 0;      ///< over the area of either [m]
};

/// Compares the deposits, the second brought to the first one's grid by area weights. Throws DataError: other CRS.
DepositDifference deposit_difference(const RunMaps& first, const RunMaps& second, double threshold);

}  // namespace talus::postprocess
