// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The waves of all patches at one placement of the later survey.
#pragma once

#include <vector>

#include "preprocess/survey/patch_spectrum.hpp"
#include "preprocess/survey/wave_bands.hpp"

namespace talus::preprocess {

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
