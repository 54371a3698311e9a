// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/fourier.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>

namespace talus {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t together = 8;  // columns gathered in one pass over the rows: a cache line holds four values

void transform_rows(std::vector<Complex>& plane, std::size_t width, std::size_t height, Eigen::FFT<double>& fft) {
  std::vector<Complex> in(width), out;
  for (std::size_t y = 0; y < height; ++y) {
    const auto line = plane.begin() + static_cast<std::ptrdiff_t>(y * width);
    std::copy_n(line, width, in.begin());
    fft.fwd(out, in);
    std::copy_n(out.begin(), width, line);
  }
}

void transform_columns(std::vector<Complex>& plane, std::size_t width, std::size_t height, Eigen::FFT<double>& fft) {
  std::vector<std::vector<Complex>> in(together, std::vector<Complex>(height)), out(together);
  for (std::size_t first = 0; first < width; first += together) {
    const std::size_t count = std::min(together, width - first);
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t k = 0; k < count; ++k) in[k][y] = plane[y * width + first + k];
    }
    for (std::size_t k = 0; k < count; ++k) fft.fwd(out[k], in[k]);
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t k = 0; k < count; ++k) plane[y * width + first + k] = out[k][y];
    }
  }
}

}  // namespace

int fourier_length(int at_least) {
  for (int n = std::max(1, at_least);; ++n) {
    int rest = n;
    for (const int prime : {2, 3, 5}) {
      while (rest % prime == 0) rest /= prime;
    }
    if (rest == 1) return n;
  }
}

void fourier_transform(std::vector<Complex>& plane, int wide, int high) {
  Eigen::FFT<double> fft;
  transform_rows(plane, static_cast<std::size_t>(wide), static_cast<std::size_t>(high), fft);
  transform_columns(plane, static_cast<std::size_t>(wide), static_cast<std::size_t>(high), fft);
}

void inverse_fourier_transform(std::vector<Complex>& plane, int wide, int high) {
  const double scale = 1 / (static_cast<double>(wide) * high);
  for (Complex& value : plane) value = std::conj(value);
  fourier_transform(plane, wide, high);
  for (Complex& value : plane) value = scale * std::conj(value);
}

}  // namespace talus
