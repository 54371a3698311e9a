// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/domain.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <fmt/format.h>

#include "common/domain/bed_numbers.hpp"
#include "common/domain/domain_layout.hpp"
#include "common/map/limits.hpp"
#include "common/stage/files.hpp"

namespace talus {
namespace fs = std::filesystem;

void ActiveCells::Layers::add(const Layers& more) {
  if (more.count() <= 0) return;
  *this = count() <= 0 ? more : Layers{std::min(first, more.first), std::max(last, more.last)};
}

ActiveCells::ActiveCells(int columns_of_map, int rows_of_map) : columns(columns_of_map), rows(rows_of_map) {
  blocks.resize(static_cast<std::size_t>(blocks_across()) * static_cast<std::size_t>(blocks_up()));
}

std::size_t ActiveCells::block_index(int column, int row) const {
  return static_cast<std::size_t>(row / side) * static_cast<std::size_t>(blocks_across()) +
         static_cast<std::size_t>(column / side);
}

bool ActiveCells::holds(const std::array<int, 3>& cell) const {
  const auto [column, row, layer] = cell;
  if (column < 0 || row < 0 || column >= columns || row >= rows) return false;
  const Layers& layers = block_of(column, row);
  return layer >= layers.first && layer <= layers.last;
}

std::size_t ActiveCells::block_count() const {
  return static_cast<std::size_t>(
      std::count_if(blocks.begin(), blocks.end(), [](const Layers& layers) { return layers.count() > 0; }));
}

std::size_t ActiveCells::cell_count() const {
  std::size_t count = 0;
  for (int row = 0; row < rows; row += side)
    for (int column = 0; column < columns; column += side) {
      const int columns_here = std::min(side, columns - column) * std::min(side, rows - row);
      count += static_cast<std::size_t>(columns_here) * static_cast<std::size_t>(block_of(column, row).count());
    }
  return count;
}

std::array<int, 3> nearest_cell(const MapGrid& map, double layer_height, const SeedPoints& points, std::size_t p) {
  const auto nearest = [](double cells) { return static_cast<int>(std::floor(cells + 0.5)); };
  return {nearest((points.x[p] - map.west) / map.cell - 0.5), nearest((points.y[p] - map.south) / map.cell - 0.5),
          std::max(0, nearest(points.height[p] / layer_height))};
}

ActiveCells active_cells(const MapGrid& map, double layer_height, const SeedPoints& points) {
  ActiveCells matter(map.columns, map.rows);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto [column, row, layer] = nearest_cell(map, layer_height, points, p);
    if (!map.holds(column, row)) continue;
    matter.block_of(column, row).add({std::max(0, layer - 1), layer + 1});
  }
  ActiveCells cells(map.columns, map.rows);
  constexpr int side = ActiveCells::side;
  for (int row = 0; row < map.rows; row += side)
    for (int column = 0; column < map.columns; column += side)
      for (int north = std::max(0, row - side); north <= row + side && north < map.rows; north += side)
        for (int east = std::max(0, column - side); east <= column + side && east < map.columns; east += side)
          cells.block_of(east, north).add(matter.block_of(column, row));
  return cells;
}

namespace {

constexpr auto plain_letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

/// A finite number at `at`, which moves behind it.
std::optional<double> number_at(const char*& at, const char* end) {
  double value = 0;
  const auto [next, error] = std::from_chars(at, end, value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  at = next;
  return value;
}

/// The cell of the map under a point; points beyond the grid belong to its edge.
std::size_t cell_under(const MapGrid& grid, double x, double y) {
  const auto place = [](double offset, int count) {
    return std::clamp(static_cast<int>(std::floor(offset)), 0, count - 1);
  };
  return grid.index(place((x - grid.west) / grid.cell, grid.columns), place((y - grid.south) / grid.cell, grid.rows));
}

constexpr double most_map_cells = 2147483647.0;  // an index of a cell is an int

[[noreturn]] void refuse_domain(const fs::path& file, const std::string& why) {
  refuse_file(file, "not a whole domain", why, "Make it with talus-preprocess");
}

struct Limits {
  double low, high;
  bool none;  ///< NaN may stand where there is no value
};

void check_sheet(const fs::path& file, const std::string& name, const Raster& raster, const Limits& limits) {
  for (std::size_t n = 0; n < raster.values.size(); ++n) {
    const double value = raster.values[n];
    if ((value >= limits.low && value <= limits.high) || (limits.none && std::isnan(value))) continue;
    const auto columns = static_cast<std::size_t>(raster.grid.columns);
    refuse_domain(file, fmt::format("the grid \"{}\" holds {:g} in column {}, row {}; {:g} to {:g} is possible", name,
                                    value, n % columns, n / columns, limits.low, limits.high));
  }
}

void check_list(const fs::path& file, const char* name, const std::vector<double>& values, const Limits& limits) {
  for (std::size_t p = 0; p < values.size(); ++p) {
    if (values[p] >= limits.low && values[p] <= limits.high) continue;
    refuse_domain(file, fmt::format("the attribute \"{}\" of point {} is {:g}; {:g} to {:g} is possible", name, p,
                                    values[p], limits.low, limits.high));
  }
}

void check_points(const fs::path& file, const Domain& domain) {
  const SeedPoints& points = domain.points;
  const MapGrid& map = domain.grid;
  constexpr double tiny = std::numeric_limits<double>::min();
  const double rim = map.cell, largest = 1e3 * map.cell;
  check_list(file, "P (east)", points.x, {map.west - rim, map.east() + rim, false});
  check_list(file, "P (north)", points.y, {map.south - rim, map.north() + rim, false});
  check_list(file, "height", points.height, {-limits::height, limits::height, false});
  check_list(file, "volume", points.volume, {tiny, largest * largest * 2 * limits::height, false});
  check_list(file, "extent_x", points.extent_x, {0, largest, false});
  check_list(file, "extent_y", points.extent_y, {0, largest, false});
  const auto releases = static_cast<int>(domain.release_names.size());
  for (std::size_t p = 0; p < points.release.size(); ++p) {
    if (points.release[p] >= 0 && points.release[p] < releases) continue;
    refuse_domain(file,
                  fmt::format("point {} is of release {}, of which there are {}", p, points.release[p], releases));
  }
}

void check_places(const fs::path& file, const Domain& domain) {
  const MapGrid& map = domain.grid;
  for (const DomainPlace& one : domain.places) {
    if (!is_plain_name(one.place) || !is_plain_name(one.name))
      refuse_domain(
          file, fmt::format("\"{}\" of the place \"{}\" is no name of letters, digits, - and _", one.name, one.place));
    for (const auto& [x, y] : one.points) {
      if (x >= map.west && x <= map.east() && y >= map.south && y <= map.north()) continue;
      refuse_domain(file, fmt::format("\"{}\" of the place \"{}\" goes to ({:g}, {:g}), beyond the map", one.name,
                                      one.place, x, y));
    }
  }
}

}  // namespace

std::vector<double> erodible_thickness(const Domain& domain) {
  std::vector<double> thickness(domain.grid.count(), 0.0);
  const SeedPoints& points = domain.points;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.release[p] < domain.erodible)
      thickness[cell_under(domain.grid, points.x[p], points.y[p])] += points.volume[p];
  for (double& value : thickness) value /= domain.grid.cell * domain.grid.cell;
  return thickness;
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name.find_first_not_of(plain_letters) == std::string::npos;
}

std::string plain_name(const std::string& name) {
  std::string plain;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t other = std::min(name.find_first_not_of(plain_letters, at), name.size());
    plain += name.substr(at, other - at);
    at = std::min(name.find_first_of(plain_letters, other), name.size());
    if (!plain.empty() && other < name.size() && at < name.size()) plain += '-';
  }
  return plain;
}

std::string text_of_points(const MapLine& points) {
  std::string text;
  for (const auto& [x, y] : points) text += fmt::format("{}{},{}", text.empty() ? "" : " ", x, y);
  return text;
}

std::optional<MapLine> points_in(const std::string& text) {
  MapLine points;
  const char *at = text.data(), *const end = text.data() + text.size();
  while (at != end) {
    if (!points.empty() && *at++ != ' ') return std::nullopt;
    const auto x = number_at(at, end);
    if (!x || at == end || *at++ != ',') return std::nullopt;
    const auto y = number_at(at, end);
    if (!y) return std::nullopt;
    points.push_back({*x, *y});
  }
  if (points.empty()) return std::nullopt;
  return points;
}

void scale_release(Domain& domain, double factor) {
  if (!(factor > 0) || !std::isfinite(factor)) throw std::logic_error("scale_release: a factor that is not positive");
  for (std::size_t i = 0; i < domain.release_thickness.values.size(); ++i) {
    double& thickness = domain.release_thickness.values[i];
    if (!(thickness > 0)) continue;  // NaN is not
    domain.before.values[i] += (factor - 1) * thickness;
    thickness *= factor;
  }
  SeedPoints& points = domain.points;
  std::vector<double> ground;
  if (domain.erodible > 0) ground = erodible_thickness(domain);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points.release[p] < domain.erodible) continue;
    points.volume[p] *= factor;
    const double foot = ground.empty() ? 0.0 : ground[cell_under(domain.grid, points.x[p], points.y[p])];
    points.height[p] = foot + factor * (points.height[p] - foot);
  }
  domain.active.reset();  // points may stand in other layers now
}

void check_domain_grid(const fs::path& file, const MapGrid& grid, double layer_height) {
  const double cells = static_cast<double>(grid.columns) * grid.rows;
  const bool sized = grid.columns > 0 && grid.rows > 0 && cells <= most_map_cells;
  if (sized && limits::hold(grid) && layer_height > 0 && layer_height < limits::cell) return;
  refuse_domain(file, fmt::format("its grid has {} x {} cells of {:g} m, layers of {:g} m, its corner at {:g} {:g}",
                                  grid.columns, grid.rows, grid.cell, layer_height, grid.west, grid.south));
}

void check_domain(const fs::path& file, const Domain& domain) {
  const Limits elevation{-limits::height, limits::height, true};
  check_sheet(file, "terrain", domain.terrain, elevation);
  check_sheet(file, "before", domain.before, elevation);
  check_sheet(file, "release_thickness", domain.release_thickness, {0, limits::height, true});
  for (const auto& [name, raster] : domain.bed) {
    if (std::find(bed_names.begin(), bed_names.end(), name) == bed_names.end())
      refuse_domain(file, fmt::format("the grid \"bed.{}\" is no number of [solve.base]", name));
    check_sheet(file, "bed." + name, raster, {-limits::number, limits::number, true});
  }
  if (domain.erodible < 0 || static_cast<std::size_t>(domain.erodible) > domain.release_names.size())
    refuse_domain(file, fmt::format("{} of its {} releases are ground", domain.erodible, domain.release_names.size()));
  check_points(file, domain);
  check_places(file, domain);
}

}  // namespace talus
