// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The random shift of a seeded point.
#pragma once

#include <random>

namespace talus::preprocess {

/// Uniform in -size..size, the same in every run and on every machine (the standard's distributions are not).
class Shift {
 public:
  explicit Shift(double size) : size_(size) {}
  double operator()() { return size_ == 0 ? 0.0 : size_ * (2 * (static_cast<double>(random_() >> 11) * 0x1p-53) - 1); }

 private:
  double size_;
  std::mt19937_64 random_{1};
};

}  // namespace talus::preprocess
