// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/random_field.hpp"

#include <algorithm>
#include <cmath>

#include "common/map/fourier.hpp"

namespace talus {
namespace {

double spherical(double distance, double range) {
  const double d = distance / range;
  return d < 1 ? 1 - 1.5 * d + 0.5 * d * d * d : 0;
}

}  // namespace

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
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const auto& both = plane_[row * static_cast<std::size_t>(wide_) + column];
      field[row * columns + column] = second_waits_ ? both.imag() : both.real();
    }
  }
  second_waits_ = !second_waits_;
  return field;
}

}  // namespace talus
