// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The difference of two deposits as a map.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/map/isolines.hpp"
#include "postprocess/compare/compare.hpp"
#include "postprocess/picture/hillshade.hpp"
#include "postprocess/picture/layers.hpp"

namespace talus::postprocess {
namespace {

/// What is shown: wherever one of the two flows came, with a margin.
Window window_of(const RunMaps& first, const RunMaps& second, double threshold) {
  const double far = 1e30;
  Window window{far, far, -far, -far};
  for (const RunMaps* maps : {&first, &second}) {
    const MapGrid& grid = maps->grid;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        if (!(maps->peak_thickness[grid.index(column, row)] > threshold)) continue;
        window = {std::min(window.west, grid.x(column)), std::min(window.south, grid.y(row)),
                  std::max(window.east, grid.x(column)), std::max(window.north, grid.y(row))};
      }
    }
  }
  const MapGrid& grid = first.grid;
  if (window.west > window.east) return {grid.west, grid.south, grid.east(), grid.north()};
  const double margin = 0.08 * std::max(window.width(), window.height()) + 3 * grid.cell;
  return {std::max(window.west - margin, grid.west), std::max(window.south - margin, grid.south),
          std::min(window.east + margin, grid.east()), std::min(window.north + margin, grid.north())};
}

/// The colour of a difference, or white below the first class.
Colour colour_of(double difference, const std::vector<double>& limits) {
  const int index = class_of(std::abs(difference), limits);
  if (index < 0) return {1, 1, 1};
  return difference_colour(difference > 0, static_cast<std::size_t>(index), limits.size());
}

void draw_difference(Canvas& canvas, const View& view, const RunMaps& first, const DepositDifference& found) {
  const MapGrid& grid = first.grid;
  const auto shades = hillshade(grid, first.before);
  const auto limits = difference_limits(found);
  const int width = static_cast<int>(view.box.width), height = static_cast<int>(view.box.height);
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0xEDF0F2);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const double x = view.window.west + (i + 0.5) / view.scale(), y = view.window.north - (j + 0.5) / view.scale();
      const int column = static_cast<int>((x - grid.west) / grid.cell),
                row = static_cast<int>((y - grid.south) / grid.cell);
      if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) continue;
      if (std::isnan(first.before[grid.index(column, row)])) continue;
      const double shade = 0.55 + 0.45 * sample(grid, shades, x, y, 1);
      pixels[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)] =
          pixel_of(scaled(colour_of(found.difference.at(column, row), limits), shade));
    }
  }
  canvas.image(static_cast<int>(view.box.x), static_cast<int>(view.box.y), width, height, pixels);
}

void draw_outline(Canvas& canvas, const View& view, const RunMaps& maps, double threshold, const Pen& pen) {
  for (const Polyline& line : isolines(maps.grid, maps.deposit_thickness, threshold, AtEdge::close)) {
    const Pixels points = on_canvas(view, line);
    if (pen.dashes.empty()) canvas.line(points, {{1, 1, 1}, pen.width + 2.5, {}, 0.8});  // dashes lie on the other line
    canvas.line(points, pen);
  }
}

/// Those of the second run that the first has as well are drawn once.
std::vector<MapPlace> places_of_both(const Run& first, const Run& second) {
  std::vector<MapPlace> places = first.summary.places;
  for (const MapPlace& place : second.summary.places)
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  return places;
}

}  // namespace

std::vector<double> difference_limits(const DepositDifference& found) {
  const double most = std::max(found.larger, found.smaller);
  if (!(most > 1e-6)) return {};  // the deposits are the same
  const double least = round_below(most / 50);
  std::vector<double> limits;
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0})
    if (least * factor < most) limits.push_back(least * factor);
  return limits;
}

std::string difference_map(const Run& first_run, const Run& second_run, const DepositDifference& found,
                           double threshold) {
  const RunMaps &first = first_run.maps, &second = second_run.maps;
  const Window window = window_of(first, second, threshold);
  const double scale = std::min(1400 / window.width(), 1000 / window.height());
  const View view{window, {0, 0, std::round(window.width() * scale), std::round(window.height() * scale)}};
  Canvas canvas(static_cast<int>(view.box.width), static_cast<int>(view.box.height));
  draw_difference(canvas, view, first, found);
  draw_contours(canvas, view, first, contour_levels(view, first));
  draw_outline(canvas, view, first, threshold, {{0.1, 0.1, 0.12}, 3, {}, 1});
  draw_outline(canvas, view, second, threshold, {{0.0, 0.45, 0.36}, 3, {14, 8}, 1});
  draw_places(canvas, view, places_of_both(first_run, second_run));
  canvas.frame(view.box, {{0.1, 0.1, 0.12}, 2.5, {}, 1});
  return canvas.png();
}

}  // namespace talus::postprocess
