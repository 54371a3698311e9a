// Any GDAL raster into memory, or a refusal with the command that mends the file.
#include <fmt/format.h>

#include <cmath>

#include "common/raster/gdal_support.hpp"
#include "common/raster/raster_io.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

using gdal::Dataset;
using gdal::QuietErrors;
using GeoTransform = std::array<double, 6>;  // x0, dx/dcolumn, dx/dline, y0, dy/dcolumn, dy/dline

/// "dem_utm.tif" beside which a mending command writes.
std::string mended(const fs::path& file, const char* suffix) { return file.stem().string() + suffix + ".tif"; }

Dataset open(const fs::path& file) {
  const QuietErrors errors;
  Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset) {
    const bool plain = file.is_absolute() && !file.string().starts_with("/vsi");
    if (plain && !fs::exists(file))
      throw DataError({file.string() + ": no such file", "", "Check the path in the recipe"});
    throw DataError(
        {file.string() + ": not a raster that can be read", errors.text(), "Look at it: gdalinfo " + file.string()});
  }
  if (dataset->GetRasterCount() == 0) {
    const char* first = CSLFetchNameValue(dataset->GetMetadata("SUBDATASETS"), "SUBDATASET_1_NAME");
    throw DataError({file.string() + ": holds no raster of its own",
                     first == nullptr ? "no band in it" : "several rasters are inside",
                     first == nullptr ? "Look at it: gdalinfo " + file.string()
                                      : fmt::format("Name one of them in the recipe, such as {}", first)});
  }
  return dataset;
}

GeoTransform square_north_up(const fs::path& file, GDALDataset& dataset) {
  GeoTransform g{};
  if (dataset.GetGeoTransform(g.data()) != CE_None)
    throw DataError({file.string() + ": has no georeference", "where its cells lie is not known",
                     fmt::format("Give its edges: gdal_translate -a_ullr WEST NORTH EAST SOUTH {} {}", file.string(),
                                 mended(file, "_placed"))});
  if (g[2] != 0 || g[4] != 0 || g[1] < 0)
    throw DataError({file.string() + ": rows and columns do not run east and north",
                     "this stage needs a raster that is not rotated or mirrored",
                     fmt::format("Turn it: gdalwarp -r bilinear {} {}", file.string(), mended(file, "_north_up"))});
  const double width = g[1], height = std::abs(g[5]);
  if (!(width > 0) || std::abs(width - height) > 1e-6 * width)
    throw DataError({fmt::format("{}: cells are {} x {}", file.string(), width, height),
                     "this stage needs square cells",
                     fmt::format("Resample: gdalwarp -tr {0} {0} -r bilinear {1} {2}", std::min(width, height),
                                 file.string(), mended(file, "_square"))});
  return g;
}

constexpr auto needs_metres = "this stage needs metres";

/// Degrees and feet are refused: nothing after this point converts units.
void require_metres(const fs::path& file, GDALDataset& dataset, const GeoTransform& g) {
  const OGRSpatialReference* srs = dataset.GetSpatialRef();
  if (srs == nullptr || srs->IsEmpty()) return;
  const QuietErrors errors;
  const double x = g[0] + g[1] * dataset.GetRasterXSize() / 2, y = g[3] + g[5] * dataset.GetRasterYSize() / 2;
  const auto reproject = [&] {
    return fmt::format("Reproject: gdalwarp -t_srs {} -r bilinear {} {}", gdal::utm_zone(*srs, x, y), file.string(),
                       mended(file, "_utm"));
  };
  const std::string crs = gdal::short_name(*srs);
  if (srs->IsGeographic())
    throw DataError({fmt::format("{}: CRS is {}, in degrees", file.string(), crs), needs_metres, reproject()});
  const char* unit = nullptr;
  if (std::abs(srs->GetLinearUnits(&unit) - 1) > 1e-9)
    throw DataError(
        {fmt::format("{}: CRS is {}, in {}", file.string(), crs, unit == nullptr ? "an unknown unit" : unit),
         needs_metres, reproject()});
}

/// Metres in one of the unit a band or a vertical CRS names; 1 where none is named or the name is not known.
double metres_in(const std::string& unit) {
  const std::string name = CPLString(unit).tolower();
  if (name.find("us") != std::string::npos &&
      (name.find("foot") != std::string::npos || name.find("ft") != std::string::npos))
    return 1200.0 / 3937.0;
  const bool foot = name == "ft" || name == "foot" || name == "feet" || name == "international foot";
  return foot ? 0.3048 : 1.0;
}

void require_metres_of_height(const fs::path& file, GDALDataset& dataset) {
  const OGRSpatialReference* srs = dataset.GetSpatialRef();
  std::string unit = dataset.GetRasterBand(1)->GetUnitType();
  if (unit.empty() && srs != nullptr && srs->IsCompound()) {
    const char* name = nullptr;
    srs->GetTargetLinearUnits("VERT_CS", &name);
    unit = name == nullptr ? "" : name;
  }
  const double factor = metres_in(unit);
  if (factor == 1.0) return;
  throw DataError({fmt::format("{}: its values are in {}", file.string(), unit), needs_metres,
                   fmt::format("Convert: gdal_calc.py -A {} --calc=A*{:.10g} --outfile={}", file.string(), factor,
                               mended(file, "_m"))});
}

/// Values as stored, first line first, with everything the file masks (nodata, mask band, alpha) as NaN.
std::vector<double> masked_values(const fs::path& file, GDALDataset& dataset) {
  const QuietErrors errors;
  auto* band = dataset.GetRasterBand(1);
  const int columns = band->GetXSize(), rows = band->GetYSize();
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<double> values(count);
  bool read =
      band->RasterIO(GF_Read, 0, 0, columns, rows, values.data(), columns, rows, GDT_Float64, 0, 0, nullptr) == CE_None;
  if (read && (band->GetMaskFlags() & GMF_ALL_VALID) == 0) {
    std::vector<GByte> mask(count);
    read = band->GetMaskBand()->RasterIO(GF_Read, 0, 0, columns, rows, mask.data(), columns, rows, GDT_Byte, 0, 0,
                                         nullptr) == CE_None;
    for (std::size_t i = 0; i < count; ++i)
      if (mask[i] == 0) values[i] = std::nan("");
  }
  if (!read || errors.failed())
    throw DataError({file.string() + ": its cells cannot be read", errors.text(),
                     "The file may be cut short; copy or download it again"});
  return values;
}

/// Grids whose header forgot to name the nodata value still use the customary ones.
void drop_undeclared_nodata(const fs::path& file, GDALRasterBand& band, std::vector<double>& values) {
  int declared = 0;
  band.GetNoDataValue(&declared);
  if (declared != 0) return;
  std::size_t dropped = 0;
  for (double& value : values) {
    if (value != -9999 && value != -32768 && !(value < -1e30 && std::isfinite(value))) continue;
    value = std::nan("");
    ++dropped;
  }
  if (dropped > 0)
    log_warning(
        fmt::format("{}: {} -9999 or the like, taken as nodata though the file names no nodata value", file.string(),
                    dropped == 1 ? "1 cell holds" : fmt::format("{} cells hold", dropped)));
}

void warn_if_degrees(const fs::path& file, const MapGrid& grid) {
  const bool like_degrees =
      grid.crs_wkt.empty() && grid.cell < 0.005 && std::abs(grid.west) <= 360 && std::abs(grid.north()) <= 90;
  if (like_degrees)
    log_warning(
        fmt::format("{}: no CRS and cells of {}: taken as metres. If these are degrees, say so: gdal_translate -a_srs "
                    "EPSG:4326 {} {}",
                    file.string(), grid.cell, file.string(), mended(file, "_degrees")));
}

/// Row 0 southernmost, scale and offset applied; infinities refused by place.
Raster assemble(const fs::path& file, GDALDataset& dataset, const GeoTransform& g, const std::vector<double>& stored) {
  auto* band = dataset.GetRasterBand(1);
  const int columns = band->GetXSize(), rows = band->GetYSize();
  const bool north_first = g[5] < 0;
  const double south = north_first ? g[3] + g[5] * rows : g[3];
  Raster raster{{columns, rows, g[0], south, g[1], gdal::horizontal_wkt(dataset.GetSpatialRef())},
                std::vector<double>(stored.size())};
  const double scale = band->GetScale(), offset = band->GetOffset();
  bool any = false;
  for (int row = 0; row < rows; ++row) {
    const int line = north_first ? rows - 1 - row : row;
    for (int column = 0; column < columns; ++column) {
      const double value = stored[raster.grid.index(column, line)] * scale + offset;
      if (std::isinf(value))
        throw DataError({fmt::format("{}: column {}, line {} (x {:.2f}, y {:.2f}) is infinite", file.string(),
                                     column + 1, line + 1, raster.grid.x(column), raster.grid.y(row)),
                         "no elevation or thickness is",
                         "Make such cells nodata: gdal_calc.py -A in.tif --calc=\"where(isfinite(A),A,-9999)\" "
                         "--NoDataValue=-9999 --outfile=out.tif"});
      any = any || !std::isnan(value);
      raster.at(column, row) = value;
    }
  }
  if (!any)
    throw DataError({file.string() + ": no cell holds a value",
                     fmt::format("all {} x {} cells are nodata", columns, rows),
                     "Check the file and its nodata value: gdalinfo -stats " + file.string()});
  return raster;
}

}  // namespace

Raster read_raster(const fs::path& file) {
  const QuietErrors errors;
  const Dataset dataset = open(file);
  GeoTransform g{};
  if (dataset->GetGeoTransform(g.data()) == CE_None)
    require_metres(file, *dataset, g);  // before the cells: degrees are seldom square
  g = square_north_up(file, *dataset);
  require_metres_of_height(file, *dataset);
  std::vector<double> stored = masked_values(file, *dataset);
  drop_undeclared_nodata(file, *dataset->GetRasterBand(1), stored);
  Raster raster = assemble(file, *dataset, g, stored);
  warn_if_degrees(file, raster.grid);
  return raster;
}

}  // namespace talus
