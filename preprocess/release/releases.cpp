// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/releases.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/raster_file.hpp"
#include "common/map/polygon.hpp"
#include "common/map/regions.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/regions/way_down.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {

Volumes volumes_of(const Raster& thickness, const std::vector<double>& cosine) {
  const double cell_area = thickness.grid.cell * thickness.grid.cell;
  Volumes v;
  Sum volume, if_normal, if_vertical, true_area;
  for (std::size_t i = 0; i < thickness.values.size(); ++i) {
    const double t = thickness.values[i];
    if (!(t > 0)) continue;
    ++v.cells;
    volume.add(t);
    if_normal.add(t / cosine[i]);
    if_vertical.add(t * cosine[i]);
    true_area.add(1 / cosine[i]);
    v.max_vertical = std::max(v.max_vertical, t);
    v.max_normal = std::max(v.max_normal, t * cosine[i]);
  }
  v.volume = volume.value() * cell_area;
  v.volume_if_normal = if_normal.value() * cell_area;
  v.volume_if_vertical = if_vertical.value() * cell_area;
  v.projected_area = static_cast<double>(v.cells) * cell_area;
  v.true_area = true_area.value() * cell_area;
  return v;
}

std::vector<std::string> as_lines(const std::string& name, const Volumes& v) {
  const bool vertical = v.given == Direction::vertical;
  const double otherwise = vertical ? v.volume_if_normal : v.volume_if_vertical;
  return {
      fmt::format("{}: {} m3: {}", name, grouped(v.volume),
                  vertical ? "vertical thickness times map area" : "slope-normal thickness times area along the bed"),
      fmt::format("  the same thickness taken as {} would be {} m3 ({:+.1f} %)", vertical ? "slope-normal" : "vertical",
                  grouped(otherwise), 100 * (otherwise / v.volume - 1)),
      fmt::format("  area {} m2 on the map, {} m2 along the bed, {} cells", grouped(v.projected_area),
                  grouped(v.true_area), v.cells),
      fmt::format("  thickness at most {} m vertical, {} m slope-normal", fixed(v.max_vertical, 2),
                  fixed(v.max_normal, 2))};
}

std::vector<std::pair<std::string, std::string>> as_facts(const Volumes& v) {
  const auto number = [](double value) { return fmt::format("{:.12g}", value); };
  return {{"released_volume_m3", number(v.volume)},
          {"volume_if_thickness_were_slope_normal_m3", number(v.volume_if_normal)},
          {"released_area_projected_m2", number(v.projected_area)},
          {"released_area_true_m2", number(v.true_area)},
          {"released_cells", std::to_string(v.cells)},
          {"max_thickness_vertical_m", number(v.max_vertical)},
          {"max_thickness_slope_normal_m", number(v.max_normal)}};
}

namespace {

void refuse_negative(const Raster& thickness, const std::filesystem::path& file) {
  std::vector<char> negative(thickness.values.size());
  double worst = 0;
  for (std::size_t i = 0; i < negative.size(); ++i) {
    negative[i] = thickness.values[i] < 0;  // false for nodata
    worst = std::min(worst, negative[i] ? thickness.values[i] : 0.0);
  }
  refuse_cells(
      thickness.grid, negative, file,
      {fmt::format("cells of negative thickness (down to {:g} m)", worst), "a release has none",
       fmt::format("Is it an elevation difference, after - before? Then: gdal_calc.py -A {} --calc \"maximum(-A,0)\" "
                   "--outfile out.tif",
                   file.string())});
}

/// The volume that cells without data would hold at the mean thickness around them, where that is a release on all
/// sides; 0 where it is not, or where they reach the edge of the raster [m3].
double missing_in(const Raster& thickness, const std::vector<std::array<int, 2>>& cells) {
  double sum = 0, count = 0;
  for (const auto& [column, row] : cells) {
    const auto near = around(thickness.grid, thickness.grid.index(column, row));
    if (near.size() < 8) return 0;
    for (const std::size_t n : near) {
      const double t = thickness.values[n];
      if (std::isnan(t)) continue;
      if (!(t > 0)) return 0;
      sum += t;
      ++count;
    }
  }
  return static_cast<double>(cells.size()) * thickness.grid.cell * thickness.grid.cell * sum / count;
}

/// Warns of cells without data that a release encloses.
void warn_of_holes(const Raster& thickness, const std::filesystem::path& file) {
  const MapGrid& grid = thickness.grid;
  std::vector<char> bare(thickness.values.size());
  double whole = 0;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    bare[i] = std::isnan(thickness.values[i]);
    if (!bare[i]) whole += thickness.values[i] * grid.cell * grid.cell;
  }
  double missing = 0;
  std::size_t cells = 0;
  std::array<int, 2> first{};
  each_cell(grid, [&](int column, int row) {
    if (!bare[grid.index(column, row)]) return;
    const auto hole = take_connected(grid, bare, {{column, row}});
    const double volume = missing_in(thickness, hole);
    if (!(volume > 0)) return;
    if (cells == 0) first = {column, row};
    cells += hole.size();
    missing += volume;
  });
  if (cells == 0) return;
  warn(
      "holes-in-release",
      fmt::format("{}: {} cells without data lie inside the release, the first at x {:.1f}, y {:.1f}. They count as no "
                  "thickness: about {} m3 are missing, {:.2g} % of what is there. Fill them (gdal_fillnodata.py {} "
                  "out.tif), or write 0 where nothing was released",
                  file.string(), cells, grid.x(first[0]), grid.y(first[1]), grouped(missing), 100 * missing / whole,
                  file.string()),
      {{"cells", static_cast<double>(cells), "1"}, {"missing_volume", missing, "m3"}});
}

Raster from_raster(const ReleaseOptions& options, const MapGrid& grid, const std::filesystem::path& model) {
  const Raster thickness = RasterFile(options.thickness_raster).read_content();
  require_comparable_crs(thickness.grid.crs_wkt, options.thickness_raster, grid.crs_wkt, model.string());
  refuse_negative(thickness, options.thickness_raster);
  warn_of_holes(thickness, options.thickness_raster);
  return thickness_onto_grid(thickness, grid, options.thickness_raster);
}

double thickness_of(const MapPolygon& polygon, std::size_t number, const ReleaseOptions& options) {
  if (options.thickness > 0) return options.thickness;
  if (options.volume > 0) return 1;
  const std::string file = options.polygons.string(), place = fmt::format("{}: polygon {}", file, number);
  std::string others;
  for (const auto& [name, value] : polygon.numbers) {
    if (name != options.attribute) {
      others += (others.empty() ? "" : ", ") + name;
    } else if (value >= 0 && std::isfinite(value)) {
      return value;
    } else {
      throw DataError({fmt::format("{}: {} = {:g}", place, name, value), "a thickness is a number and not negative",
                       "Mend the attribute, or give thickness_m in the recipe"});
    }
  }
  for (const TextField& text :
       text_fields(options.polygons, [&](std::string_view n) { return n == options.attribute; }))
    throw DataError({fmt::format("{}: feature {}: {} = \"{}\"", file, text.feature, text.field, text.text),
                     "it is a text and no number, and a thickness is wanted",
                     "Write it as a number with a point for its decimals, or give thickness_m"});
  throw DataError({fmt::format("{}: no number \"{}\" among its attributes ({})", place, options.attribute,
                               others.empty() ? "it has none" : others),
                   "its thickness is not known",
                   "Name the attribute in the recipe (attribute = ...), or give thickness_m"});
}

Raster from_polygons(const ReleaseOptions& options, const MapGrid& grid) {
  const std::vector<MapPolygon> polygons = read_grown_polygons(options.polygons, grid.crs_wkt, options.grow);
  Raster thickness{grid, std::vector<double>(grid.count(), 0.0)};
  std::vector<double> covered(grid.count(), 0.0);
  bool overlap = false;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const double height = thickness_of(polygons[p], p + 1, options);
    const std::vector<double> part = coverage(grid, polygons[p], options.polygons);
    for (std::size_t i = 0; i < part.size(); ++i) {
      thickness.values[i] += part[i] * height;
      covered[i] += part[i];
      overlap = overlap || covered[i] > 1 + 1e-9;
    }
  }
  if (overlap)
    warn("polygons-overlap", options.polygons.string() + ": its polygons overlap; their thicknesses add up there");
  return thickness;
}

void refuse_release_on_nodata(const Raster& thickness, const Raster& bed, const std::filesystem::path& file) {
  std::vector<char> bad(bed.values.size());
  for (std::size_t i = 0; i < bad.size(); ++i) bad[i] = thickness.values[i] > 0 && std::isnan(bed.values[i]);
  refuse_cells(bed.grid, bad, file,
               {"cells of release where the DEM has no elevation", "nothing holds it up there",
                "Fill the DEM, or cut the release"});
}

}  // namespace

void warn_of_overlap(const std::vector<Release>& releases) {
  for (std::size_t a = 0; a < releases.size(); ++a) {
    for (std::size_t b = a + 1; b < releases.size(); ++b) {
      std::size_t shared = 0;
      for (std::size_t i = 0; i < releases[a].thickness.values.size(); ++i)
        shared += releases[a].thickness.values[i] > 0 && releases[b].thickness.values[i] > 0;
      if (shared > 0)
        warn("releases-overlap",
             fmt::format("{} and {} share {} cells; there the second lies on the first", releases[a].name,
                         releases[b].name, shared),
             {{"cells", static_cast<double>(shared), "1"}});
    }
  }
}

Release read_release(const ReleaseOptions& options, std::size_t item, const Raster& bed,
                     const std::filesystem::path& model) {
  const auto& file = options.polygons.empty() ? options.thickness_raster : options.polygons;
  Release release{options.name.empty() ? fmt::format("release-{}", item + 1) : options.name,
                  options.polygons.empty() ? from_raster(options, bed.grid, model) : from_polygons(options, bed.grid),
                  options.direction};
  if (std::ranges::none_of(release.thickness.values, [](double t) { return t > 0; }))
    throw DataError({file.string() + ": its thickness is 0 everywhere", "the source is empty",
                     "Check the values with gdalinfo -stats or ogrinfo -al"});
  refuse_release_on_nodata(release.thickness, bed, file);
  if (options.direction == Direction::slope_normal) {
    const std::vector<double> cosine = slope_cosine(bed);
    for (std::size_t i = 0; i < cosine.size(); ++i) release.thickness.values[i] /= cosine[i];
  }
  if (options.volume > 0) {
    const double area = bed.grid.cell * bed.grid.cell;
    const double factor = options.volume / (area * std::accumulate(release.thickness.values.begin(),
                                                                   release.thickness.values.end(), 0.0));
    for (double& t : release.thickness.values) t *= factor;
  }
  return release;
}

}  // namespace talus::preprocess
