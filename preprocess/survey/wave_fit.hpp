// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The shift that is left between two surveys, by the waves of all patches in bands of wavelengths.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "preprocess/survey/patches.hpp"

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

/// Waves of slopes and misfit, on cells that have not changed, are not too steep and do not stand out of the misfit by
/// more than 4.685 NMAD, with the sums over their bands. The patches must outlive it.
class WaveFit {
 public:
  /// Chooses the cells, and measures what the slopes of both surveys share at a placement.
  WaveFit(const std::vector<Patch>& patches, const Placement& placement);
  /// False where no patch has enough cells that count.
  bool enough() const { return !slopes_.empty(); }
  /// Measures the misfit at a placement; false where cells that count have none there.
  bool measure(const Placement& placement);
  /// What the bands say of the placement last measured; `phase` as for fit_bands().
  BandFit fit(const Eigen::Vector2d& phase) const { return fit_bands(bands_, share_, phase); }
  /// Variance of the shift by the spread of what tiles say [cells^2], of the placement last measured.
  Eigen::Vector2d spread(const BandFit& fit) const;

 private:
  void add_patch(const Patch& patch, const Placement& placement, double centre, double limit);
  void number_bands(int wide, int high);
  void add_folded();
  /// visit(place, place of the mirrored wave, column, row), but for the mean.
  template <class Visit>
  void each_wave(const Visit& visit) const;
  double number(int index, int count) const { return (index <= count / 2 ? index : index - count) / double(count); }

  const std::vector<Patch>& patches_;
  std::vector<std::size_t> from_;  // patches that count
  std::vector<PatchWindow> windows_;
  std::vector<std::vector<char>> used_;
  std::vector<Waves> slopes_;        // east + i north, of each
  std::vector<Waves> misfits_;       // as last measured
  std::vector<unsigned char> band_;  // of each wave
  std::vector<WaveBand> bands_;
  double share_ = 0;
};

}  // namespace talus::preprocess
