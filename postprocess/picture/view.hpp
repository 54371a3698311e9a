// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where map coordinates fall on the picture.
#pragma once

#include <array>

#include "postprocess/fields/window.hpp"
#include "postprocess/picture/canvas.hpp"

namespace talus::postprocess {

/// Map coordinates to pixels.
struct View {
  Window window;
  Box box;  // on the canvas
  /// Pixels to a metre.
  double scale() const { return box.width / window.width(); }  // [px/m]
  /// The place of map coordinates (x, y) on the canvas [px].
  std::array<double, 2> pixel(double x, double y) const {
    return {box.x + (x - window.west) * scale(), box.y + (window.north - y) * scale()};
  }
};

}  // namespace talus::postprocess
