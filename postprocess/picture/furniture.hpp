// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What stands around the map: title, coordinates, legend, scale, north arrow, numbers.
#pragma once

#include <vector>

#include "postprocess/picture/layers.hpp"

namespace talus::postprocess {

/// Draws the title of the run, from (x, y), no wider than `width` [px].
void draw_title(Canvas& canvas, const PictureInput& input, double x, double y, double width);
/// Draws ticks and their coordinates along the edge of the map.
void draw_coordinates(Canvas& canvas, const View& view);

/// Everything in the column right of the map, from `y` downwards.
void draw_sidebar(Canvas& canvas, const PictureInput& input, const View& view, const std::vector<double>& limits,
                  double interval, const Box& box);

/// The time in the map's upper left corner.
void draw_time(Canvas& canvas, double time, const View& view);

/// One line of small print.
void draw_footer(Canvas& canvas, const PictureInput& input, double x, double y);

/// "36.0 million m³", "22 500 m³": three figures, thousands apart.
std::string volume_words(double volume);

}  // namespace talus::postprocess
