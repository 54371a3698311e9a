// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/check_domain.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/domain/bed_numbers.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

constexpr double highest = 1e5;  // [m]; no ground of the Earth is a tenth of it away from the sea's level

[[noreturn]] void refuse_domain(const fs::path& file, const std::string& why) {
  refuse_file(file, "not a whole domain", why, "Make it with talus-preprocess");
}

/// Numbers from low to high.
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
  check_list(file, "height", points.height, {-highest, highest, false});
  check_list(file, "volume", points.volume, {tiny, largest * largest * 2 * highest, false});
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

void check_domain_grid(const fs::path& file, const MapGrid& grid, double layer_height) {
  const double cells = static_cast<double>(grid.columns) * grid.rows;
  const bool sized = grid.columns > 0 && grid.rows > 0 && cells <= most_map_cells;
  const bool placed = std::abs(grid.west) < 1e12 && std::abs(grid.south) < 1e12;
  const bool spaced = grid.cell > 0 && grid.cell < 1e9 && layer_height > 0 && layer_height < 1e9;
  if (sized && placed && spaced) return;
  refuse_domain(file, fmt::format("its grid has {} x {} cells of {:g} m, layers of {:g} m, its corner at {:g} {:g}",
                                  grid.columns, grid.rows, grid.cell, layer_height, grid.west, grid.south));
}

void check_domain(const fs::path& file, const Domain& domain) {
  const Limits elevation{-highest, highest, true};
  check_sheet(file, "terrain", domain.terrain, elevation);
  check_sheet(file, "before", domain.before, elevation);
  check_sheet(file, "release_thickness", domain.release_thickness, {0, highest, true});
  for (const auto& [name, raster] : domain.bed) {
    if (std::find(bed_numbers.begin(), bed_numbers.end(), name) == bed_numbers.end())
      refuse_domain(file, fmt::format("the grid \"bed.{}\" is no number of [solve.base]", name));
    check_sheet(file, "bed." + name, raster, {-1e30, 1e30, true});
  }
  if (domain.erodible < 0 || static_cast<std::size_t>(domain.erodible) > domain.release_names.size())
    refuse_domain(file, fmt::format("{} of its {} releases are ground", domain.erodible, domain.release_names.size()));
  check_points(file, domain);
  check_places(file, domain);
}

}  // namespace talus
