// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Colours and words of map classes, one definition for pictures and styles. Knows nothing of GDAL.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace talus {

/// A colour by its parts of red, green and blue.
struct Colour {
  double r = 0, g = 0, b = 0;  // sRGB, 0 to 1
};

/// `heat`: pale yellow over orange and red to near black (thickness, pressure). `sea`: pale green over blue to a dark
/// violet (speed, time).
enum class Ramp { heat, sea };

/// Colour of class `index` of `count`, from little to much. Lightness falls in equal steps of OKLab (Ottosson 2020), so
/// equal steps look equal and the order survives any colour blindness.
Colour class_colour(std::size_t index, std::size_t count, Ramp ramp = Ramp::heat);

/// Colour of a class of differences, `index` of `count` away from none: blue for a loss, red for a gain, both from pale
/// to dark by the same steps of lightness. Blue and red differ under every common colour blindness.
Colour difference_colour(bool gain, std::size_t index, std::size_t count);

/// "5 - 10" with an en dash, "> 100" for the last.
std::string class_label(std::size_t index, const std::vector<double>& limits);

/// "#rrggbb".
std::string hex(const Colour& colour);

}  // namespace talus
