// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/picture/layers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus::postprocess {
namespace {

constexpr Colour place_edge{0.10, 0.11, 0.13}, place_fill{0.95, 0.76, 0.31};
constexpr std::size_t most_named = 12;
constexpr double dot = 8, letters = 22;  // [px]

/// A ring on the canvas; a circle for a point.
Pixels shape_of(const std::vector<std::array<double, 2>>& ring, const View& view) {
  Pixels shape;
  if (ring.size() > 1) {
    for (const auto& [x, y] : ring) shape.push_back(view.pixel(x, y));
    shape.push_back(shape.front());
    return shape;
  }
  const auto [x, y] = view.pixel(ring[0][0], ring[0][1]);
  for (int k = 0; k <= 24; ++k) {
    const double angle = 2 * std::numbers::pi * k / 24;
    shape.push_back({x + dot * std::cos(angle), y + dot * std::sin(angle)});
  }
  return shape;
}

bool reaches_into(const MapPlace& place, const Window& window) {
  return std::any_of(place.rings.begin(), place.rings.end(), [&](const auto& ring) {
    return std::any_of(ring.begin(), ring.end(), [&](const auto& at) {
      return at[0] > window.west && at[0] < window.east && at[1] > window.south && at[1] < window.north;
    });
  });
}

/// The easternmost place of the first ring, where the name begins, turned to the left where it would leave the view.
void draw_name(Canvas& canvas, const View& view, const MapPlace& place) {
  const auto& ring = place.rings[0];
  const auto east =
      *std::max_element(ring.begin(), ring.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  const auto [x, y] = view.pixel(east[0], east[1]);
  TextStyle style{.size = letters, .bold = true, .colour = place_edge, .halo = 5};
  const std::string name = name_of(place);
  if (x + dot + 6 + canvas.text_width(name, style) > view.box.x + view.box.width) style.align = Align::right;
  canvas.text(name, style.align == Align::right ? x - dot - 6 : x + dot + 6, y + 0.35 * letters, style);
}

}  // namespace

std::string name_of(const MapPlace& place) {
  const auto space = place.words.find(' ');
  return space == std::string::npos ? place.words : place.words.substr(space + 1);
}

void draw_places(Canvas& canvas, const View& view, const std::vector<MapPlace>& places) {
  for (const MapPlace& place : places) {
    if (!reaches_into(place, view.window)) continue;
    for (const auto& ring : place.rings) {
      const Pixels shape = shape_of(ring, view);
      canvas.fill(shape, place_fill);
      canvas.line(shape, {place_edge, 2.5, {}, 1});
    }
    if (places.size() <= most_named) draw_name(canvas, view, place);
  }
}

}  // namespace talus::postprocess
