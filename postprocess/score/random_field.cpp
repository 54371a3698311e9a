#include "postprocess/score/random_field.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>

namespace talus::postprocess {
namespace {

/// The next number that has no prime factor beyond 5: such lengths are transformed fast.
int smooth_length(int at_least) {
  for (int n = at_least;; ++n) {
    int rest = n;
    for (const int prime : {2, 3, 5}) {
      while (rest % prime == 0) rest /= prime;
    }
    if (rest == 1) return n;
  }
}

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
  wide_ = smooth_length(std::max(columns_ + reach, 2 * reach));
  high_ = smooth_length(std::max(rows_ + reach, 2 * reach));
  const auto width = static_cast<std::size_t>(wide_), count = width * static_cast<std::size_t>(high_);
  plane_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int x = static_cast<int>(i % width), y = static_cast<int>(i / width);
    plane_[i] = spherical(std::hypot(std::min(x, wide_ - x), std::min(y, high_ - y)), cells);
  }
  transform(plane_);
  for (const auto& value : plane_)
    amplitude_.push_back(std::sqrt(std::max(0.0, value.real()) / static_cast<double>(count)));
}

void RandomField::transform(std::vector<Complex>& plane) const {
  Eigen::FFT<double> fft;
  const auto width = static_cast<std::size_t>(wide_), height = static_cast<std::size_t>(high_);
  std::vector<Complex> in(width), out;
  for (std::size_t y = 0; y < height; ++y) {
    std::copy_n(plane.begin() + static_cast<std::ptrdiff_t>(y * width), width, in.begin());
    fft.fwd(out, in);
    std::copy_n(out.begin(), width, plane.begin() + static_cast<std::ptrdiff_t>(y * width));
  }
  in.resize(height);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t y = 0; y < height; ++y) in[y] = plane[y * width + x];
    fft.fwd(out, in);
    for (std::size_t y = 0; y < height; ++y) plane[y * width + x] = out[y];
  }
}

void RandomField::draw() {
  for (std::size_t i = 0; i < plane_.size(); ++i) {
    const double real = normal_(random_), imaginary = normal_(random_);
    plane_[i] = amplitude_[i] * Complex(real, imaginary);
  }
  transform(plane_);
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

}  // namespace talus::postprocess
