// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The shift that is left between two surveys, by bands of wavelengths.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace talus::preprocess {

/// Sums over the waves of one band of half an octave. Slopes in metres a cell, misfits in metres.
struct WaveBand {
  double waves = 0;                                  ///< how many
  double number = 0;                                 ///< sum of their wave numbers [1/cell]
  Eigen::Matrix2d slope = Eigen::Matrix2d::Zero();   ///< power of the slopes of the survey before
  Eigen::Matrix2d shared = Eigen::Matrix2d::Zero();  ///< what the slopes of both surveys have in common
  Eigen::Vector2d folded =
      Eigen::Vector2d::Zero();                     ///< pull of waves shorter than two cells, if all are at their worst
  Eigen::Vector2d pull = Eigen::Vector2d::Zero();  ///< slope times misfit
  double misfit = 0;                               ///< power of the misfit

  /// Share of the slopes' power that is terrain, 0 to 1; the rest is noise of the survey before.
  double terrain() const;
};

/// What the bands say together.
struct BandFit {
  bool known = false;                                          ///< false: no shift makes the misfit smaller
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();             ///< that is left [cells]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();        ///< of it, by the noise of the bands [cells^2]
  Eigen::Matrix2d inverse_response = Eigen::Matrix2d::Zero();  ///< shift over weighted pull
  Eigen::Vector2d folded = Eigen::Vector2d::Zero();            ///< error by waves shorter than two cells [cells]
  std::vector<double> weight;                                  ///< of each band
};

/// Weighted least squares for the shift, by the relation misfit = slope * shift of every wave (Nuth & Kaeaeb 2011, eq.
/// 2, times the slope). A band weighs by its terrain over its noise, and its noise is measured: it is what of the
/// misfit no shift explains. So noise that is alike over many cells does not pull, nor do the short waves in which a
/// noisy survey shows slopes that are none. Waves shorter than two cells pose as longer ones and pull towards whole
/// cells, the more so the more of them there are: an error common to all bands, of size `phase` (sine of 2 pi times the
/// part of a cell by which the posts of both lie apart, east and north) times WaveBand::folded, against which the bands
/// are weighed as against noise. `share` is PatchWindow::share().
BandFit fit_bands(const std::vector<WaveBand>& bands, double share, const Eigen::Vector2d& phase);

/// The power law k^-n of the terrain's height by the wave number k: n, from waves of four to twelve cells, which have
/// little of what is folded; 3, as of rough terrain, where noise hides them. Between 2 and 8.
double fall_of_terrain(const std::vector<WaveBand>& bands);

}  // namespace talus::preprocess
