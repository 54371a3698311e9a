// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Survey errors as they might have been: random, but alike where cells are near.
#pragma once

#include <complex>
#include <cstdint>
#include <random>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// Gaussian random fields of mean 0 and variance 1 on a map, the correlation of two cells at distance d being
/// spherical, 1 - 1.5 (d/a) + 0.5 (d/a)^3 up to the range a, 0 beyond it (Matheron 1963). By circulant embedding
/// (Dietrich and Newsam 1997): on a torus that is the range wider than the map the transform of the correlation is not
/// negative, so the fields are exact. Two come out of one Fourier transform. Equal seeds give equal fields.
class RandomField {
 public:
  /// `range` in m; up to a cell: every cell for itself. Ranges beyond three times the map's longer side count as that.
  RandomField(const MapGrid& grid, double range, std::uint64_t seed);

  std::vector<double> next();  ///< [rows * columns]
  /// The method begins the series of a seed, as a new object would, without the spectrum being made again.
  void start(std::uint64_t seed);

 private:
  using Complex = std::complex<double>;
  void draw();

  int columns_, rows_;
  int wide_ = 0, high_ = 0;        // of the torus; 0: uncorrelated
  std::vector<double> amplitude_;  // square root of the spectrum over the number of cells
  std::vector<Complex> plane_;     // two fields: real and imaginary part
  bool second_waits_ = false;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace talus
