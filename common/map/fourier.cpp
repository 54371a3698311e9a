// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/fourier.hpp"

#include <algorithm>
#include <cmath>

#include <unsupported/Eigen/FFT>

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
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t k = 0; k < count; ++k) in[k][y] = plane[y * width + first + k];
    for (std::size_t k = 0; k < count; ++k) fft.fwd(out[k], in[k]);
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t k = 0; k < count; ++k) plane[y * width + first + k] = out[k][y];
  }
}

double spherical(double distance, double range) {
  const double d = distance / range;
  return d < 1 ? 1 - 1.5 * d + 0.5 * d * d * d : 0;
}

}  // namespace

int fourier_length(int at_least) {
  for (int n = std::max(1, at_least);; ++n) {
    int rest = n;
    for (const int prime : {2, 3, 5})
      while (rest % prime == 0) rest /= prime;
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

RandomField::RandomField(const MapGrid& grid, double range, std::uint64_t seed)
    : columns_(grid.columns), rows_(grid.rows), random_(seed) {
  const double cells = std::min(range / grid.cell, 3.0 * std::max(columns_, rows_));
  if (!(cells > 1)) return;
  const int reach = static_cast<int>(std::ceil(cells));
  wide_ = fourier_length(std::max(columns_ + reach, 2 * reach));
  high_ = fourier_length(std::max(rows_ + reach, 2 * reach));
  const auto width = static_cast<std::size_t>(wide_), count = width * static_cast<std::size_t>(high_);
  plane_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int x = static_cast<int>(i % width), y = static_cast<int>(i / width);
    plane_[i] = spherical(std::hypot(std::min(x, wide_ - x), std::min(y, high_ - y)), cells);
  }
  fourier_transform(plane_, wide_, high_);
  for (const auto& value : plane_)
    amplitude_.push_back(std::sqrt(std::max(0.0, value.real()) / static_cast<double>(count)));
}

void RandomField::start(std::uint64_t seed) {
  random_.seed(seed);
  normal_.reset();
  second_waits_ = false;
}

void RandomField::draw() {
  for (std::size_t i = 0; i < plane_.size(); ++i) {
    const double real = normal_(random_), imaginary = normal_(random_);
    plane_[i] = amplitude_[i] * Complex(real, imaginary);
  }
  fourier_transform(plane_, wide_, high_);
}

std::vector<double> RandomField::next() {
  const auto columns = static_cast<std::size_t>(columns_), rows = static_cast<std::size_t>(rows_);
  std::vector<double> field(columns * rows);
  if (wide_ == 0) {
    for (double& v : field) v = normal_(random_);
    return field;
  }
  if (!second_waits_) draw();
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const auto& both = plane_[row * static_cast<std::size_t>(wide_) + column];
      field[row * columns + column] = second_waits_ ? both.imag() : both.real();
    }
  second_waits_ = !second_waits_;
  return field;
}

}  // namespace talus
