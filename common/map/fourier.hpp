// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Fourier transforms of maps.
#pragma once

#include <complex>
#include <vector>

namespace talus {

/// The least number from `at_least` on that has no prime factor beyond 5: such lengths are transformed fast.
int fourier_length(int at_least);

/// The discrete Fourier transform of a plane [high * wide], row by row, in place: the sum of value times exp(-2 pi i
/// (column * m / wide + row * n / high)), not scaled.
void fourier_transform(std::vector<std::complex<double>>& plane, int wide, int high);

/// The inverse of fourier_transform(), in place.
void inverse_fourier_transform(std::vector<std::complex<double>>& plane, int wide, int high);

}  // namespace talus
