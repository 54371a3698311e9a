// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/patch_spectrum.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/map/fourier.hpp"

namespace talus::preprocess {

namespace {

constexpr double faded = 0.125;       // of the width, on each side
constexpr double least_share = 0.02;  // of the cells of a patch: with fewer its fields are all but filled

/// A cosine's rise from 0 to 1 at both ends.
std::vector<double> fading(int count) {
  std::vector<double> fade(static_cast<std::size_t>(count), 1.0);
  const int rise = std::max(4, static_cast<int>(faded * count));
  for (int i = 0; i < std::min(rise, count); ++i) {
    const double value = 0.5 - 0.5 * std::cos(std::numbers::pi * (i + 0.5) / rise);
    const auto first = static_cast<std::size_t>(i), last = static_cast<std::size_t>(count - 1 - i);
    fade[first] = std::min(fade[first], value);
    fade[last] = std::min(fade[last], value);
  }
  return fade;
}

}  // namespace

PatchWindow::PatchWindow(const MapGrid& grid, std::vector<char> used)
    : columns_(grid.columns),
      rows_(grid.rows),
      wide_(fourier_length(grid.columns)),
      high_(fourier_length(grid.rows)),
      used_(std::move(used)),
      fade_x_(fading(grid.columns)),
      fade_y_(fading(grid.rows)) {
  std::size_t i = 0, count = 0;
  for (const double y : fade_y_) {
    for (const double x : fade_x_) {
      count += used_[i] != 0;
      share_ += used_[i++] ? x * x * y * y : 0;
    }
  }
  share_ /= static_cast<double>(wide_) * high_;
  enough_ = static_cast<double>(count) > std::max(64.0, least_share * static_cast<double>(used_.size()));
}

std::vector<double> PatchWindow::without_plane(const std::vector<double>& field) const {
  const auto row_of = [&](std::size_t i) {
    const auto columns = static_cast<std::size_t>(columns_);
    const std::size_t row = i / columns, column = i % columns;
    return Eigen::Vector3d(1, static_cast<double>(column) / columns_ - 0.5, static_cast<double>(row) / rows_ - 0.5);
  };
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (!used_[i]) continue;
    const Eigen::Vector3d row = row_of(i);
    matrix += row * row.transpose();
    right += field[i] * row;
  }
  const Eigen::Vector3d plane = matrix.ldlt().solve(right);
  std::vector<double> rest(field.size(), 0.0);
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (used_[i]) rest[i] = field[i] - plane.dot(row_of(i));
  }
  return rest;
}

std::vector<double> PatchWindow::prepared(const std::vector<double>& field) const {
  std::vector<double> ready = smooth_fill(without_plane(field), used_, columns_, rows_);
  std::size_t i = 0;
  for (const double y : fade_y_) {
    for (const double x : fade_x_) ready[i++] *= x * y;
  }
  return ready;
}

Waves PatchWindow::waves(const std::vector<double>& first, const std::vector<double>& second) const {
  const std::vector<double> real = prepared(first), imaginary = second.empty() ? second : prepared(second);
  Waves waves(static_cast<std::size_t>(wide_) * static_cast<std::size_t>(high_));
  const auto columns = static_cast<std::size_t>(columns_), width = static_cast<std::size_t>(wide_);
  for (std::size_t i = 0; i < real.size(); ++i)
    waves[i / columns * width + i % columns] = {real[i], imaginary.empty() ? 0.0 : imaginary[i]};
  fourier_transform(waves, wide_, high_);
  return waves;
}

}  // namespace talus::preprocess
