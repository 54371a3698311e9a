// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/inflow_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/error.hpp"

namespace talus::solver {
namespace {

/// Ground that falls by less in the direction of a flow than this does not say which way it goes [-].
constexpr double level_ground = 1e-6;
/// The least angle between the flow and its line, as its sine [-]: 30 degrees.
constexpr double least_sine = 0.5;

CellPlace cells_of(const MapGrid& map, const std::array<double, 2>& at) {
  return {(at[0] - map.west) / map.cell - 0.5, (at[1] - map.south) / map.cell - 0.5};
}

void refuse_outside(const InflowOptions& o, const std::string& place, const MapGrid& map, std::size_t end) {
  throw RecipeError(
      {fmt::format("{}: ({}, {}) lies outside the known ground, or at its edge", place, o.line[end][0], o.line[end][1]),
       "what enters needs known ground one cell around it",
       fmt::format("Choose x from {} to {} and y from {} to {}, away from cells without elevation", map.x(1),
                   map.x(map.columns - 2), map.y(1), map.y(map.rows - 2))});
}

/// The flow's direction: as given, or across the line to the side where the ground falls.
CellPlace direction(const InflowOptions& o, const std::string& place, const CellPlace& across, double slope) {
  if (!o.azimuth) {
    if (std::abs(slope) > level_ground) return slope < 0 ? across : CellPlace{-across[0], -across[1]};
    throw RecipeError({fmt::format("{}: across its line the ground falls by {:.2g} on average", place, -slope),
                       "on level ground nothing says which way the flow goes",
                       "Give azimuth_deg, the direction of the flow from north over east"});
  }
  const double turn = *o.azimuth * (std::numbers::pi / 180);
  const CellPlace ahead{std::sin(turn), std::cos(turn)};
  const double sine = std::abs(ahead[0] * across[0] + ahead[1] * across[1]);
  if (sine >= least_sine) return ahead;
  throw RecipeError({fmt::format("{}: azimuth_deg = {:g} runs at {:.0f} deg to the line", place, *o.azimuth,
                                 std::asin(sine) * (180 / std::numbers::pi)),
                     "below 30 deg the line hardly lies across the flow",
                     "Turn the line across the flow, or leave azimuth_deg out"});
}

}  // namespace

bool InflowTerrain::open(const CellPlace& at) const {
  const int i = static_cast<int>(std::floor(at[0] + 0.5)), j = static_cast<int>(std::floor(at[1] + 0.5));
  return i >= 0 && j >= 0 && i < shape.columns && j < shape.rows && terrain.open[shape.index(i, j)] != 0;
}

CellPlace InflowTerrain::slope(const CellPlace& at) const {
  const double i0 = std::clamp(std::floor(at[0]), 0.0, shape.columns - 2.0),
               j0 = std::clamp(std::floor(at[1]), 0.0, shape.rows - 2.0);
  const double a = at[0] - i0, b = at[1] - j0;
  const auto mean = [&](const std::vector<double>& slopes) {
    const auto value = [&](int i, int j) {
      return slopes[shape.index(static_cast<int>(i0) + i, static_cast<int>(j0) + j)];
    };
    return (1 - b) * ((1 - a) * value(0, 0) + a * value(1, 0)) + b * ((1 - a) * value(0, 1) + a * value(1, 1));
  };
  return {mean(terrain.slope_x), mean(terrain.slope_y)};
}

InflowLine inflow_line(const InflowOptions& o, const std::string& place, const MapGrid& map,
                       const InflowTerrain& terrain) {
  InflowLine line;
  line.from = cells_of(map, o.line[0]);
  line.to = cells_of(map, o.line[1]);
  for (std::size_t end = 0; end < 2; ++end)
    if (!terrain.open(end == 0 ? line.from : line.to)) refuse_outside(o, place, map, end);
  const double x = line.to[0] - line.from[0], y = line.to[1] - line.from[1], length = std::hypot(x, y);
  const int strips = std::max(1, static_cast<int>(std::lround(length * o.points_per_cell[1])));
  const CellPlace across{y / length, -x / length};  // to the right of the line
  double slope_x = 0, slope_y = 0;
  for (int s = 0; s < strips; ++s) {
    const double share = (s + 0.5) / strips;
    const CellPlace middle{line.from[0] + share * x, line.from[1] + share * y};
    if (!terrain.open(middle))
      throw RecipeError({fmt::format("{}: the ground is not known all along its line", place),
                         "what enters needs known ground one cell around it",
                         "Move the line, or fill the model's voids"});
    line.middles.push_back(middle);
    line.ground.height.push_back(terrain_at(terrain.shape, terrain.terrain, middle[0], middle[1]));
    slope_x += terrain.slope(middle)[0] / strips;
    slope_y += terrain.slope(middle)[1] / strips;
  }
  line.ahead = direction(o, place, across, slope_x * across[0] + slope_y * across[1]);
  line.ground.slope = slope_x * line.ahead[0] + slope_y * line.ahead[1];
  line.ground.strip = length * map.cell / strips * std::abs(line.ahead[0] * across[0] + line.ahead[1] * across[1]);
  return line;
}

}  // namespace talus::solver
