// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/commands.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/map/statistics.hpp"
#include "common/map/usual_reach.hpp"

namespace talus::command {
namespace {

constexpr double gravity = 9.81;
constexpr double degrees = 180 / std::numbers::pi;
// The bed's friction over the tangent at which the centre of mass goes: the rest is lost inside. Of seven slides whose
// friction is known or was fitted 0.82 to 0.88, of one over a cliff 0.63 (docs/notes/surveys-and-release.md).
constexpr double bed_share = 0.85;
constexpr double cells_wanted = 20, fewest_cells = 8, layers_wanted = 4.5, points_in_a_cell = 8;

/// The number of `count` digits at the place of `digit`, without the noise of binary fractions.
double of_digits(double count, double digit) { return digit < 1 ? count / std::round(1 / digit) : count * digit; }

/// Two digits, not more than the number.
double round_down(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return of_digits(std::floor(value / digit + 1e-9), digit);
}

/// Two digits, not less than the number.
double round_up(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return of_digits(std::ceil(value / digit - 1e-9), digit);
}

bool is_in(const Raster& raster, int column, int row) {
  return raster.grid.holds(column, row) && raster.at(column, row) > 0;
}

/// Place and weight of what a raster of thickness holds.
struct Centre {
  double x = 0, y = 0, z = 0, weight = 0;
  void add(double at_x, double at_y, double at_z, double thickness) {
    x += at_x * thickness;
    y += at_y * thickness;
    z += at_z * thickness;
    weight += thickness;
  }
  double drop_to(const Centre& other) const { return z / weight - other.z / other.weight; }
  double distance_to(const Centre& other) const {
    return std::hypot(x / weight - other.x / other.weight, y / weight - other.y / other.weight);
  }
};

template <class Visit>
void for_each_cell(const Raster& raster, const Visit& visit) {
  for (int row = 0; row < raster.grid.rows; ++row)
    for (int column = 0; column < raster.grid.columns; ++column)
      if (raster.at(column, row) > 0) visit(column, row);
}

/// Height of the straight line from the crown to the deposit above the ground, at its largest.
double largest_head(const Slide& slide, const Raster& before, double from_x, double from_y, double to_x, double to_y) {
  const MapGrid& grid = before.grid;
  const int steps = std::max(1, static_cast<int>(slide.length / grid.cell));
  double most = 0;
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const auto column = static_cast<int>((from_x + share * (to_x - from_x) - grid.west) / grid.cell);
    const auto row = static_cast<int>((from_y + share * (to_y - from_y) - grid.south) / grid.cell);
    if (!grid.holds(column, row)) continue;
    const double ground = before.at(column, row), line = slide.crown - share * slide.drop;
    if (std::isfinite(ground)) most = std::max(most, line - ground);
  }
  return most;
}

/// What the deposit says of the way.
void measure_way(Slide& slide, const Raster& before, const Raster& deposit, const Centre& from, double crown_x,
                 double crown_y) {
  const MapGrid& grid = before.grid;
  Centre to;
  double tip_x = 0, tip_y = 0, tip_z = 0;
  for_each_cell(deposit, [&](int column, int row) {
    const double x = grid.x(column), y = grid.y(row), z = before.at(column, row), t = deposit.at(column, row);
    if (!std::isfinite(z)) return;
    to.add(x, y, z + t / 2, t);
    const double distance = std::hypot(x - crown_x, y - crown_y);
    if (distance <= slide.length) return;
    slide.length = distance;
    tip_x = x;
    tip_y = y;
    tip_z = z;
  });
  slide.drop = slide.crown - tip_z;
  if (slide.length > 0) slide.travel_tangent = from.drop_to(to) / std::max(from.distance_to(to), grid.cell);
  if (!(slide.drop > 0) || !(slide.travel_tangent > 0)) {  // no mass goes uphill
    slide.length = slide.drop = slide.travel_tangent = 0;
    return;
  }
  slide.head = largest_head(slide, before, crown_x, crown_y, tip_x, tip_y);
}

}  // namespace

Slide measure_slide(const Raster& before, const Raster& release, const std::optional<Raster>& deposit) {
  const MapGrid& grid = release.grid;
  Slide slide;
  slide.cell = grid.cell;
  slide.median_thickness = median_thickness(release);
  slide.crown = -1e30;
  Centre from;
  double crown_x = 0, crown_y = 0;
  std::size_t cells = 0, sides = 0;
  for_each_cell(release, [&](int column, int row) {
    ++cells;
    for (const auto& [i, j] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      sides += !is_in(release, column + i, row + j);
    const double x = grid.x(column), y = grid.y(row), z = before.at(column, row), t = release.at(column, row);
    if (!std::isfinite(z)) return;
    from.add(x, y, z - t / 2, t);
    if (z <= slide.crown) return;
    slide.crown = z;
    crown_x = x;
    crown_y = y;
  });
  if (cells == 0) return {};
  slide.area = static_cast<double>(cells) * grid.cell * grid.cell;
  slide.volume = from.weight * grid.cell * grid.cell;
  slide.width = 4 * slide.area / (static_cast<double>(sides) * grid.cell);
  if (deposit) measure_way(slide, before, *deposit, from, crown_x, crown_y);
  return slide;
}

double usual_reach_tangent(double volume) {
  for (const ReachRegression& one : reach_regressions())
    if (volume >= one.from_volume) return one.tangent(volume);
  return reach_regressions().back().tangent(volume);
}

Proposal propose(const Slide& slide) {
  Proposal p;
  const double wanted = std::max(slide.width / cells_wanted, slide.cell);
  p.spacing = round_down(std::min(wanted, slide.width / fewest_cells));
  p.layer_height = std::min(round_down(slide.median_thickness / layers_wanted), p.spacing);
  p.layers = slide.median_thickness / p.layer_height;
  p.cells_across = slide.width / p.spacing;
  p.points = slide.volume / (p.spacing * p.spacing * p.layer_height) * points_in_a_cell;
  const double reach = usual_reach_tangent(slide.volume);
  const double tangent = std::clamp(slide.travel_tangent > 0 ? bed_share * slide.travel_tangent : reach, 0.05, 0.9);
  p.bed_angle = std::round(2 * std::atan(tangent) * degrees) / 2;
  p.internal_angle = std::round(2 * std::atan(std::min(1.4 * tangent, 0.85)) * degrees) / 2;
  const double drop = slide.has_deposit() ? slide.drop : std::cbrt(slide.volume) * 4;  // nobody knows the way
  const double length = slide.has_deposit() ? slide.length : drop / reach;
  const double speed = std::sqrt(2 * gravity * std::max(slide.head, 0.1 * drop));
  p.end_time = std::max(10.0, round_up(4 * std::hypot(length, drop) / speed));
  return p;
}

}  // namespace talus::command
