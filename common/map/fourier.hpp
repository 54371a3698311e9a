// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Fourier transforms of maps, and random fields made by them: survey errors as they might have been.
#pragma once

#include <complex>
#include <cstdint>
#include <random>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// The least number from `at_least` on that has no prime factor beyond 5: such lengths are transformed fast.
int fourier_length(int at_least);

/// The discrete Fourier transform of a plane [high * wide], row by row, in place: the sum of value times exp(-2 pi i
/// (column * m / wide + row * n / high)), not scaled.
void fourier_transform(std::vector<std::complex<double>>& plane, int wide, int high);

/// The inverse of fourier_transform(), in place.
void inverse_fourier_transform(std::vector<std::complex<double>>& plane, int wide, int high);

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
