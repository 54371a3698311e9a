// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/read_raster.hpp"

#include <cpl_string.h>
#include <fmt/format.h>

#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"
#include "common/gis/raster_file.hpp"
#include "common/gis/raster_source.hpp"

namespace talus {
namespace fs = std::filesystem;

using gdal::mended;
using gdal::QuietErrors;
using gdal::RasterSource;

Raster read_raster(const fs::path& file) { return RasterFile(file).read(); }

Raster read_raster_in_metres(const fs::path& file, const std::string& crs_wkt) {
  return RasterFile(file, {in_metres(file) ? "" : crs_wkt, "", ""}).read();
}

bool in_metres(const fs::path& file) { return RasterSource(file, "metre").in_metres(); }

std::string utm_crs_of(const fs::path& file) {
  const RasterSource source(file, "metre");
  if (source.srs() == nullptr || !source.placed())
    throw DataError(
        {file.string() + ": has no CRS", "so its UTM zone cannot be told",
         fmt::format("Give it one: gdal_translate -a_srs EPSG:<code> {} {}", file.string(), mended(file, "_placed"))});
  const auto [x, y] = source.centre();
  const std::string zone = gdal::utm_zone(*source.srs(), x, y);
  OGRSpatialReference srs;
  const QuietErrors errors;
  if (srs.SetFromUserInput(zone.c_str()) != OGRERR_NONE)
    throw DataError({fmt::format("{}: its centre, {:.6g}, {:.6g} in {}, lies in no UTM zone", file.string(), x, y,
                                 gdal::short_name(*source.srs())),
                     "these reach from 80 degrees south to 84 north", "Check its CRS, or name a CRS in metres"});
  return gdal::horizontal_wkt(&srs);
}

std::optional<double> raster_item(const std::filesystem::path& file, const std::string& name) {
  gdal::require_local(file);
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset)
    throw DataError(
        {file.string() + ": not a raster that can be read", errors.text(), "Look at it: gdalinfo " + file.string()});
  const char* text = dataset->GetMetadataItem(name.c_str());
  if (text == nullptr || CPLGetValueType(text) == CPL_VALUE_STRING) return std::nullopt;
  return CPLAtof(text);
}

}  // namespace talus
