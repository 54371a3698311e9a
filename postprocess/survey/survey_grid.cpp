// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/survey/survey_grid.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/resampling.hpp"
#include "common/map/slope.hpp"

namespace talus::postprocess {

bool same_grid(const MapGrid& a, const MapGrid& b) {
  const double slack = 1e-6 * a.cell;
  return a.columns == b.columns && a.rows == b.rows && std::abs(a.west - b.west) < slack &&
         std::abs(a.south - b.south) < slack && std::abs(a.cell - b.cell) * std::max(a.columns, a.rows) < slack;
}

void check_crs(const std::filesystem::path& file, const MapGrid& grid, const MapGrid& run) {
  if (same_crs(grid.crs_wkt, run.crs_wkt)) return;
  const auto mend = run.crs_wkt.empty() || grid.crs_wkt.empty()
                        ? fmt::format("If the coordinates fit, name the CRS: gdal_edit.py -a_srs {} {}",
                                      run.crs_wkt.empty() ? "None" : crs_name(run.crs_wkt), file.string())
                        : fmt::format("Reproject: gdalwarp -t_srs {} {} out.tif", crs_name(run.crs_wkt), file.string());
  throw DataError({fmt::format("{}: CRS is {}", file.string(), crs_name(grid.crs_wkt)),
                   fmt::format("the run is in {}", crs_name(run.crs_wkt)), mend});
}

std::vector<double> on_grid(const Raster& raster, const MapGrid& grid) {
  return same_grid(raster.grid, grid) ? raster.values : resample_thickness(raster, grid).values;
}

void to_vertical(Raster& raster, const SurveyOptions& options, const RunMaps& maps) {
  if (options.direction != Direction::slope_normal) return;
  const auto cosine = on_grid({maps.grid, slope_cosine({maps.grid, maps.terrain})}, raster.grid);
  for (std::size_t i = 0; i < cosine.size(); ++i) {
    if (cosine[i] > 0) raster.values[i] /= cosine[i];  // beyond the run's ground: as it is
  }
}

}  // namespace talus::postprocess
