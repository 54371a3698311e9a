// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "postprocess/picture/picture.hpp"

namespace talus::postprocess {
namespace {

double shade(double slope_x, double slope_y) {
  constexpr double height = 45 * std::numbers::pi / 180;
  const double length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  const double aspect = std::atan2(-slope_x, -slope_y);  // downslope, clockwise from north
  double sum = 0, weights = 0;
  for (const double azimuth_deg : {225.0, 270.0, 315.0, 360.0}) {
    const double azimuth = azimuth_deg * std::numbers::pi / 180;
    const double light = (-slope_x * std::sin(azimuth) * std::cos(height) -
                          slope_y * std::cos(azimuth) * std::cos(height) + std::sin(height)) /
                         length;
    const double across = std::sin(aspect - azimuth);
    const double weight = across * across + 0.15;  // the constant keeps some of the light that falls straight on
    sum += weight * std::max(light, 0.0);
    weights += weight;
  }
  return sum / weights;
}

void stretch(std::vector<double>& shades) {
  std::vector<double> sorted;
  std::copy_if(shades.begin(), shades.end(), std::back_inserter(sorted), [](double s) { return std::isfinite(s); });
  if (sorted.empty()) return;
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[sorted.size() / 50], high = sorted[sorted.size() - 1 - sorted.size() / 50];
  const double middle = 0.5 * (low + high), span = std::max(high - low, 0.12);  // a plain stays plain
  for (double& s : shades) s = std::clamp(0.5 + (s - middle) / span, 0.0, 1.0);
}

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

constexpr Colour beyond_domain{0.93, 0.94, 0.95};

double length(const Pixels& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    sum += std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]);
  return sum;
}

void draw(Canvas& canvas, const View& view, const std::vector<Polyline>& lines, const LineStyle& style) {
  for (const auto& pen : {style.casing, style.pen})
    for (const auto& line : lines) {
      const auto points = on_canvas(view, line);
      auto solid = pen;
      solid.dashes.clear();  // a ring of two dashes or fewer is a crumb, not an outline
      if (pen.width > 0) canvas.line(points, length(points) < 90 ? solid : pen);
    }
}

/// The elevation along a contour, upright, where the line is straightest within the frame.
void label_contour(Canvas& canvas, const View& view, const Polyline& line, double level) {
  const auto points = on_canvas(view, line);
  TextStyle style{.size = 17, .colour = {0.3, 0.32, 0.34}, .align = Align::centre, .halo = 2.5};
  const auto words = fmt::format("{:g}", level);
  const double half = 0.5 * canvas.text_width(words, style) + 6;
  double best = std::numeric_limits<double>::infinity(), x = nan, y = nan, angle = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [px, py] = points[i];
    const bool inside = px > view.box.x + 60 && px < view.box.x + view.box.width - 60 && py > view.box.y + 60 &&
                        py < view.box.y + view.box.height - 60;
    std::size_t from = i, to = i;
    while (from > 0 && std::hypot(points[from][0] - px, points[from][1] - py) < half) --from;
    while (to + 1 < points.size() && std::hypot(points[to][0] - px, points[to][1] - py) < half) ++to;
    const double dx = points[to][0] - points[from][0], dy = points[to][1] - points[from][1], chord = std::hypot(dx, dy);
    if (!inside || chord < 2 * half * 0.98) continue;
    double bend = 0;
    for (std::size_t k = from; k <= to; ++k) {
      bend = std::max(bend,
                      std::abs((points[k][0] - points[from][0]) * dy - (points[k][1] - points[from][1]) * dx) / chord);
    }
    if (bend >= best) continue;
    best = bend;
    x = 0.5 * (points[from][0] + points[to][0]);
    y = 0.5 * (points[from][1] + points[to][1]);
    angle = std::atan2(-dy, dx);
  }
  if (best > 6) return;
  if (std::abs(angle) > std::numbers::pi / 2) angle -= std::copysign(std::numbers::pi, angle);
  style.angle = angle;
  canvas.text(words, x + 6 * std::sin(angle), y + 6 * std::cos(angle), style);
}

/// Elevations inside the frame [m], nodata left out.
std::vector<double> elevations(const View& view, const RunMaps& maps) {
  std::vector<double> inside;
  const auto& grid = maps.grid;
  for (std::size_t i = 0; i < grid.count(); ++i) {
    const auto [column, row] = grid.cell_of(i);
    const double x = grid.x(column), y = grid.y(row), z = maps.before[i];
    if (std::isfinite(z) && x >= view.window.west && x <= view.window.east && y >= view.window.south &&
        y <= view.window.north)
      inside.push_back(z);
  }
  return inside;
}

/// The elevation below which a part of the cells lies; `all` is put into another order.
double quantile(std::vector<double>& all, double part) {
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), place, all.end());
  return *place;
}

}  // namespace

std::vector<double> hillshade(const MapGrid& grid, const std::vector<double>& elevation) {
  std::vector<double> shades(elevation.size(), nan);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double own = elevation[grid.index(column, row)];
      if (std::isnan(own)) continue;
      const auto z = [&](int dx, int dy) {  // of a neighbour; the cell's own where there is none
        const double there =
            elevation[grid.index(std::clamp(column + dx, 0, grid.columns - 1), std::clamp(row + dy, 0, grid.rows - 1))];
        return std::isnan(there) ? own : there;
      };
      const double east = z(1, -1) + 2 * z(1, 0) + z(1, 1), west = z(-1, -1) + 2 * z(-1, 0) + z(-1, 1);
      const double north = z(-1, 1) + 2 * z(0, 1) + z(1, 1), south = z(-1, -1) + 2 * z(0, -1) + z(1, -1);
      shades[grid.index(column, row)] = shade((east - west) / (8 * grid.cell), (north - south) / (8 * grid.cell));
    }
  stretch(shades);
  return shades;
}

double sample(const MapGrid& grid, const std::vector<double>& values, double x, double y, double missing) {
  const double u = std::clamp((x - grid.west) / grid.cell - 0.5, 0.0, grid.columns - 1.0);
  const double v = std::clamp((y - grid.south) / grid.cell - 0.5, 0.0, grid.rows - 1.0);
  const int column = std::min(static_cast<int>(u), std::max(grid.columns - 2, 0));
  const int row = std::min(static_cast<int>(v), std::max(grid.rows - 2, 0));
  const double fx = u - column, fy = v - row;
  double sum = 0;
  for (const int dy : {0, 1})
    for (const int dx : {0, 1}) {
      const double weight = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy);
      if (weight == 0) continue;
      const double value = values[grid.index(column + dx, row + dy)];
      sum += weight * (std::isnan(value) ? missing : value);
    }
  return sum;
}

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

Colour scaled(const Colour& c, double factor) { return {c.r * factor, c.g * factor, c.b * factor}; }

std::uint32_t pixel_of(const Colour& c) {
  const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(255 * std::clamp(v, 0.0, 1.0))); };
  return byte(c.r) << 16U | byte(c.g) << 8U | byte(c.b);
}

Pixels on_canvas(const View& view, const Polyline& line) {
  Pixels points;
  for (const auto& [x, y] : line) points.push_back(view.pixel(x, y));
  return points;
}

std::vector<Polyline> rings(const std::vector<MapPolygon>& polygons) {
  std::vector<Polyline> lines;
  for (const auto& polygon : polygons)
    for (auto ring : polygon.rings) {
      if (!ring.empty()) ring.push_back(ring.front());
      lines.push_back(std::move(ring));
    }
  return lines;
}

std::vector<Polyline> footprint_lines(const Survey& survey) {
  if (!survey.polygons.empty()) return rings(survey.polygons);
  if (survey.footprint.empty()) return {};
  return isolines(survey.grid, survey.footprint, survey.footprint_threshold, AtEdge::close);
}

Pen contour_pen(bool is_index) { return {{0.33, 0.36, 0.40}, is_index ? 1.5 : 0.9, {}, is_index ? 0.55 : 0.38}; }

void draw_ground(Canvas& canvas, const View& view, const RunMaps& maps, const std::vector<double>& limits) {
  const auto shades = hillshade(maps.grid, maps.before);
  std::vector<Colour> colours;
  for (std::size_t i = 0; i < limits.size(); ++i) colours.push_back(class_colour(i, limits.size()));
  const int width = static_cast<int>(view.box.width), height = static_cast<int>(view.box.height);
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int row) {
    std::uint32_t* pixel = pixels.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
    const double y = view.window.north - (row + 0.5) / view.scale();
    for (int column = 0; column < width; ++column) {
      const double x = view.window.west + (column + 0.5) / view.scale();
      const double shade = sample(maps.grid, shades, x, y, nan);
      const int place = class_of(sample(maps.grid, maps.deposit_thickness, x, y, 0), limits);
      const double bright = std::isnan(shade) ? 0.5 : shade;
      const Colour colour = place >= 0          ? scaled(colours[static_cast<std::size_t>(place)], 0.87 + 0.18 * bright)
                            : std::isnan(shade) ? beyond_domain
                                                : scaled({0.985, 0.99, 1.0}, 0.64 + 0.34 * bright);
      *pixel++ = pixel_of(colour);
    }
  });
  canvas.image(static_cast<int>(view.box.x), static_cast<int>(view.box.y), width, height, pixels);
}

void draw_contours(Canvas& canvas, const View& view, const RunMaps& maps, const ContourLevels& levels) {
  for (long k = levels.first; k <= levels.last; ++k) {
    const double level = static_cast<double>(k) * levels.interval;
    const auto lines = isolines(maps.grid, maps.before, level, AtEdge::end);
    for (const auto& line : lines) canvas.line(on_canvas(view, line), contour_pen(k % 5 == 0));
    if (k % 5 != 0 || lines.empty()) continue;
    const auto longest =
        std::max_element(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
    label_contour(canvas, view, *longest, level);
  }
}

void draw_hazard(Canvas& canvas, const View& view, const MapGrid& grid, const Hazard& hazard) {
  if (!hazard.cones.empty())
    draw(canvas, view, isolines(grid, reached_cells(hazard.cones.front()), 0.5, AtEdge::close), reach_style);
  for (const Building& building : hazard.buildings) draw(canvas, view, rings(building.parts), building_style);
}

void draw_outlines(Canvas& canvas, const View& view, const RunMaps& maps, const PictureInput& input) {
  const auto& options = input.options;
  draw(canvas, view, isolines(maps.grid, maps.peak_thickness, options.footprint_threshold, AtEdge::close),
       footprint_style);
  const auto draw_release = [&] {
    draw(canvas, view, isolines(maps.grid, maps.initial_thickness, options.deposit_threshold, AtEdge::close),
         release_style);
  };
  if (!input.survey) return draw_release();
  const auto& survey = *input.survey;
  if (!survey.footprint.empty())
    draw(canvas, view, footprint_lines(survey), survey.deposit.empty() ? survey_style : survey_footprint_style);
  draw_release();
  if (survey.deposit.empty()) return;
  const auto lines = isolines(survey.grid, survey.deposit, options.deposit_threshold, AtEdge::close);
  draw(canvas, view, lines, survey_style);
}

ContourLevels contour_levels(const View& view, const RunMaps& maps) {
  constexpr double rare = 0.005;  // of the cells, at either end
  std::vector<double> all = elevations(view, maps);
  if (all.empty()) return {};
  const auto [least, most] = std::minmax_element(all.begin(), all.end());
  const double low = *least, high = *most;
  if (!(high > low)) return {};
  double bottom = quantile(all, rare), top = quantile(all, 1 - rare);
  if (!(top > bottom)) bottom = low, top = high;  // a plain with something on it
  const double interval = round_below((top - bottom) / 10), relief = top - bottom;
  // Summits and gorges beyond the usual get their contours too, as far again as the relief; spikes do not.
  const double from = std::max(low, bottom - relief / 2), to = std::min(high, top + relief / 2);
  const double first = std::ceil(from / interval), last = std::floor(to / interval);
  constexpr double countable = 1e15;  // a relief of nothing at an elevation without end has no contours
  if (!(std::abs(first) < countable && std::abs(last) < countable)) return {};
  return {interval, static_cast<long>(first), static_cast<long>(last)};
}

}  // namespace talus::postprocess
