// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/raster_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <utility>

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_utils.h>

#include "common/gis/crs.hpp"
#include "common/gis/declared_heights.hpp"
#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"
#include "common/gis/resampling.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/table_lines.hpp"

namespace talus::gdal {
namespace fs = std::filesystem;
namespace {

Dataset open_any(const fs::path& file, const AsciiGrid& ascii) {
  constexpr unsigned how = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  return ascii.is_one() ? open_ascii_grid(ascii.path(), how) : Dataset(GDALDataset::Open(file.c_str(), how));
}

constexpr auto copy_again = "Copy or download it again";

Dataset open(const fs::path& file, const AsciiGrid& ascii) {
  const WhileReading reading(file, copy_again);
  const QuietErrors errors;
  Dataset dataset = open_any(file, ascii);
  if (!dataset) {
    const bool plain = file.is_absolute() && !file.string().starts_with("/vsi");
    if (plain && !fs::exists(file))
      throw DataError({file.string() + ": no such file", "", "Check the path in the recipe"});
    throw DataError(no_dataset(file, "a raster", errors.text(), "gdalinfo"));
  }
  if (dataset->GetDriver() != nullptr && EQUAL(dataset->GetDriver()->GetDescription(), "XYZ"))
    for (TableLines lines(file, copy_again); lines.next();) {  // GDAL guesses at signs that part thousands
    }
  if (dataset->GetRasterCount() == 0) {
    const char* first = CSLFetchNameValue(dataset->GetMetadata("SUBDATASETS"), "SUBDATASET_1_NAME");
    throw DataError({file.string() + ": holds no raster of its own",
                     first == nullptr ? "no band in it" : "several rasters are inside",
                     first == nullptr ? "Look at it: gdalinfo " + file.string()
                                      : fmt::format("Name one of them in the recipe, such as {}", first)});
  }
  int bands = 0;
  for (int b = 1; b <= dataset->GetRasterCount(); ++b)
    bands += dataset->GetRasterBand(b)->GetColorInterpretation() == GCI_AlphaBand ? 0 : 1;
  if (bands > 1)
    throw DataError({fmt::format("{}: it has {} bands", file.string(), bands),
                     "a picture, or several quantities or times: which one is meant is not said",
                     fmt::format("Take one of them: gdal_translate -b 1 {} out.tif", file.string())});
  return dataset;
}

std::unique_ptr<AsciiGrid> ascii_grid(const fs::path& file) {
  require_local(file);
  const QuietErrors errors;
  return std::make_unique<AsciiGrid>(file);
}

/// A unit of lengths, and what says so.
struct LengthUnit {
  double metres;
  std::string name, by;
};

bool differ(const LengthUnit& a, const LengthUnit& b) {
  constexpr double between_feet = 1e-5;  // the two feet differ by 2e-6, and "ft" does not say which of them is meant
  return std::abs(a.metres / b.metres - 1) > between_feet;
}

/// Whether a unit is a length, or a word that may be one.
bool may_be_length(const std::string& unit) { return !unit.empty() && !is_no_length(unit); }

/// What a file declares, the band before the vertical axis of the CRS. Where the band says feet and the axis says
/// which, the axis alone.
std::vector<LengthUnit> declared_units(GDALRasterBand& band, const DeclaredHeights& heights) {
  std::vector<LengthUnit> units;
  const std::string unit = band.GetUnitType();
  if (const auto metres = metres_in(unit); may_be_length(unit) && metres)
    units.push_back({*metres, unit, "the unit of its band"});
  if (heights.metres == 0) return units;
  const LengthUnit axis{heights.metres, heights.unit, "the vertical axis of its CRS"};
  if (!units.empty() && !differ(units.front(), axis)) units.clear();
  units.push_back(axis);
  return units;
}

/// No height, and no other quantity of a slide, is as large; grids use such values for nodata without always saying so.
bool beyond_all_heights(double value) { return std::isfinite(value) && std::abs(value) >= 1e30; }

/// A source's cells for the warper, in metres, NaN for nodata. Exceptions wait here until GDAL has returned.
class PlainCells final : public GDALDataset {
 public:
  explicit PlainCells(RasterSource& source);

  const OGRSpatialReference* GetSpatialRef() const override { return &srs_; }
  CPLErr GetGeoTransform(double* g) override {
    std::copy(transform_.begin(), transform_.end(), g);
    return CE_None;
  }
  const fs::path& file() const { return source_.file(); }
  std::exception_ptr take_fault() { return std::exchange(fault_, nullptr); }

 private:
  friend class PlainBand;
  RasterSource& source_;
  OGRSpatialReference srs_;
  GeoTransform transform_;
  std::exception_ptr fault_;
};

class PlainBand final : public GDALRasterBand {
 public:
  PlainBand(PlainCells* cells, std::array<int, 2> block) {
    poDS = cells;
    nBand = 1;
    eDataType = GDT_Float64;
    nBlockXSize = std::min(block[0], cells->GetRasterXSize());
    nBlockYSize = std::min(block[1], cells->GetRasterYSize());
  }
  double GetNoDataValue(int* declared) override {
    if (declared != nullptr) *declared = 1;
    return std::nan("");
  }

 protected:
  CPLErr IReadBlock(int block_column, int block_line, void* data) override {
    auto& cells = *static_cast<PlainCells*>(poDS);
    const int column = block_column * nBlockXSize, line = block_line * nBlockYSize;
    const int columns = std::min(nBlockXSize, nRasterXSize - column),
              lines = std::min(nBlockYSize, nRasterYSize - line);
    try {
      const std::vector<double> values = cells.source_.read(column, line, columns, lines);
      const auto width = static_cast<std::size_t>(columns);
      for (std::size_t l = 0; l < static_cast<std::size_t>(lines); ++l)
        std::memcpy(static_cast<double*>(data) + l * static_cast<std::size_t>(nBlockXSize), values.data() + l * width,
                    width * sizeof(double));
      return CE_None;
    } catch (...) {
      cells.fault_ = std::current_exception();
      CPLError(CE_Failure, CPLE_FileIO, "cells cannot be read");
      return CE_Failure;
    }
  }
};

PlainCells::PlainCells(RasterSource& source) : source_(source), srs_(*source.srs()), transform_(source.transform()) {
  nRasterXSize = source.columns();
  nRasterYSize = source.lines();
  srs_ = horizontal(srs_);  // or GDAL would convert heights on its own
  srs_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (srs_.IsGeographic() && transform_[0] >= 180) transform_[0] -= 360;  // 0..360 degrees
  SetBand(1, new PlainBand(this, source.block()));
}

/// To two digits: cells of 26 m rather than 25.73 m, so that two surveys of one place share their cells.
double rounded(double length) {
  const double unit = std::pow(10, std::floor(std::log10(length)) - 1);
  return std::round(length / unit) * unit;
}

[[noreturn]] void refuse(const RasterSource& source, const OGRSpatialReference& srs, const std::string& why) {
  throw DataError({fmt::format("{}: cannot be reprojected from {} to {}", source.file().string(),
                               short_name(*source.srs()), short_name(srs)),
                   why, "Check its coordinates and CRS: gdalinfo " + source.file().string()});
}

/// The side of a square as large as the source's middle cell [m].
double cell_size(const RasterSource& source, const GeoTransform& g, OGRCoordinateTransformation& to) {
  const double c = 0.5 * source.columns(), l = 0.5 * source.lines();
  std::array<double, 3> x{}, y{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double column = c + (i == 1), line = l + (i == 2);
    x[i] = g[0] + g[1] * column + g[2] * line;
    y[i] = g[3] + g[4] * column + g[5] * line;
  }
  to.Transform(3, x.data(), y.data());
  return std::sqrt(std::abs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])));
}

MapGrid grid_around(const RasterSource& source, const PlainCells& cells, const OGRSpatialReference& srs) {
  GeoTransform g{};
  const_cast<PlainCells&>(cells).GetGeoTransform(g.data());
  const Transformation to = transformation(*cells.GetSpatialRef(), srs, source.file().string());
  const double cell = cell_size(source, g, *to);
  const double c = source.columns(), l = source.lines();
  const auto [west, east] = std::minmax({g[0], g[0] + g[1] * c, g[0] + g[2] * l, g[0] + g[1] * c + g[2] * l});
  const auto [south, north] = std::minmax({g[3], g[3] + g[4] * c, g[3] + g[5] * l, g[3] + g[4] * c + g[5] * l});
  std::array<double, 4> bounds{};
  constexpr int edge_points = 21;
  const bool moved =
      to->TransformBounds(west, south, east, north, &bounds[0], &bounds[1], &bounds[2], &bounds[3], edge_points) != 0;
  if (!moved || !(cell > 0) || !std::isfinite(cell)) refuse(source, srs, "its coordinates do not fit its CRS");
  MapGrid grid;
  grid.cell = rounded(cell);
  const double first_column = std::floor(bounds[0] / grid.cell), first_row = std::floor(bounds[1] / grid.cell);
  grid.west = first_column * grid.cell;
  grid.south = first_row * grid.cell;
  grid.columns = static_cast<int>(std::ceil(bounds[2] / grid.cell) - first_column);
  grid.rows = static_cast<int>(std::ceil(bounds[3] / grid.cell) - first_row);
  grid.crs_wkt = horizontal_wkt(&srs);
  return grid;
}

Dataset warp(const RasterSource& source, GDALDataset& cells, const MapGrid& grid, const OGRSpatialReference& srs) {
  CPLStringList words;
  const auto add = [&](std::initializer_list<std::string> arguments) {
    for (const std::string& argument : arguments) words.AddString(argument.c_str());
  };
  const auto number = [](double value) { return fmt::format("{:.17g}", value); };
  add({"-of", "VRT", "-ot", "Float64", "-dstnodata", "nan", "-r", "bilinear"});
  add({"-t_srs", grid.crs_wkt, "-ts", std::to_string(grid.columns), std::to_string(grid.rows)});
  add({"-te", number(grid.west), number(grid.south), number(grid.east()), number(grid.north())});
  // Coordinates to a thousandth of a cell. And the plain bilinear kernel also where cells grow by a tenth: GDAL's wider
  // one, meant for overviews, would put a slope off by hundredths of a cell.
  add({"-et", "0.001", "-wo", "XSCALE=1", "-wo", "YSCALE=1"});
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(words.List(), nullptr);
  GDALDatasetH from = GDALDataset::ToHandle(&cells);
  const QuietErrors errors;
  Dataset warped(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &from, options, nullptr)));
  GDALWarpAppOptionsFree(options);
  if (!warped) refuse(source, srs, errors.text());
  return warped;
}

}  // namespace

std::string mended(const fs::path& file, const char* suffix) { return file.stem().string() + suffix + ".tif"; }

RasterSource::RasterSource(fs::path file, const ReadOptions& how)
    : file_(std::move(file)),
      ascii_(ascii_grid(file_)),
      dataset_(open(file_, *ascii_)),
      band_(dataset_->GetRasterBand(1)) {
  const auto [across, along] = block();
  require_room(across, along, 2 * sizeof(double), file_.string() + " is stored in blocks; one of them",
               "Write it in tiles: gdal_translate -co TILED=YES in.tif out.tif");
  const QuietErrors errors;
  placed_ = dataset_->GetGeoTransform(transform_.data()) == CE_None;
  scale_ = band_->GetScale();
  offset_ = band_->GetOffset();
  heights_ = declared_heights(dataset_->GetSpatialRef(), file_);
  if (how.are_lengths) take_unit(how.vertical_unit);
}

/// The unit of the recipe goes before that of the band, and this before that of the CRS's vertical axis.
void RasterSource::take_unit(const std::string& vertical_unit) {
  const std::string file = file_.string(), of_band = band_->GetUnitType();
  if (heights_.downwards)
    throw DataError({file + ": the vertical axis of its CRS counts downwards", "this stage needs heights",
                     fmt::format("Turn the values (gdal_calc.py -A {} --calc=\"-1.0*A\" --outfile=out.tif), and give "
                                 "out.tif a CRS of heights (gdal_edit.py -a_srs)",
                                 file)});
  const bool given = !vertical_unit.empty();
  if (!given && may_be_length(of_band) && !metres_in(of_band))
    throw DataError({fmt::format("{}: its values are in \"{}\"", file, of_band),
                     "this unit of length is not known, and this stage needs metres",
                     fmt::format("If they are metres, say so: gdal_edit.py -units m {}", file)});
  std::vector<LengthUnit> units = declared_units(*band_, heights_);
  if (given) units.insert(units.begin(), {metres_in(vertical_unit).value_or(1.0), vertical_unit, "vertical_unit"});
  if (units.empty()) return;
  const LengthUnit& taken = units.front();
  for (const LengthUnit& other : units)
    if (differ(taken, other))
      warn("vertical-unit", fmt::format("{}: heights are taken to be in {} ({}), though {} says {}", file, taken.name,
                                        taken.by, other.by, other.name));
  if (taken.metres == 1.0) return;
  scale_ *= taken.metres;
  offset_ *= taken.metres;
  log_info(fmt::format("{}: heights {} {}, converted to metres (x {:.10g})", file, given ? "taken as" : "are in",
                       taken.name, taken.metres));
}

int RasterSource::columns() const { return dataset_->GetRasterXSize(); }
int RasterSource::lines() const { return dataset_->GetRasterYSize(); }

const OGRSpatialReference* RasterSource::srs() const {
  const OGRSpatialReference* srs = dataset_->GetSpatialRef();
  return places_nothing(srs) ? nullptr : srs;
}

bool RasterSource::in_metres() const {
  const QuietErrors errors;
  const OGRSpatialReference* own = srs();
  return own == nullptr || (!own->IsGeographic() && std::abs(own->GetLinearUnits() - 1) <= 1e-9);
}

std::array<double, 2> RasterSource::centre() const {
  const double column = 0.5 * columns(), line = 0.5 * lines();
  const auto& g = transform_;
  return {g[0] + g[1] * column + g[2] * line, g[3] + g[4] * column + g[5] * line};
}

std::array<int, 2> RasterSource::block() const {
  std::array<int, 2> size{};
  band_->GetBlockSize(&size[0], &size[1]);
  return size;
}

std::vector<double> RasterSource::read(int column, int line, int columns, int lines) {
  const WhileReading reading(file_, copy_again);
  const QuietErrors errors;
  std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines));
  const bool read = band_->RasterIO(GF_Read, column, line, columns, lines, values.data(), columns, lines, GDT_Float64,
                                    0, 0, nullptr) == CE_None;
  if (read) drop_masked(values, column, line, columns, lines);
  if (!read || errors.failed())
    throw DataError({file_.string() + ": its cells cannot be read", errors.text(),
                     "The file may be cut short; copy or download it again"});
  drop_undeclared(values);
  if (scale_ != 1 || offset_ != 0)
    for (double& value : values) value = value * scale_ + offset_;
  refuse_infinite(values, column, line, columns);
  return values;
}

/// Everything that the file masks: nodata, mask band, alpha.
void RasterSource::drop_masked(std::vector<double>& values, int column, int line, int columns, int lines) {
  if ((band_->GetMaskFlags() & GMF_ALL_VALID) != 0) {
    // GDAL takes an alpha of real numbers for no mask.
    for (int b = 2; b <= dataset_->GetRasterCount(); ++b) {
      if (dataset_->GetRasterBand(b)->GetColorInterpretation() != GCI_AlphaBand) continue;
      std::vector<double> alpha(values.size());
      if (dataset_->GetRasterBand(b)->RasterIO(GF_Read, column, line, columns, lines, alpha.data(), columns, lines,
                                               GDT_Float64, 0, 0, nullptr) != CE_None)
        return;
      for (std::size_t i = 0; i < values.size(); ++i)
        if (alpha[i] == 0) values[i] = std::nan("");
    }
    return;
  }
  std::vector<GByte> mask(values.size());
  if (band_->GetMaskBand()->RasterIO(GF_Read, column, line, columns, lines, mask.data(), columns, lines, GDT_Byte, 0, 0,
                                     nullptr) != CE_None)
    return;  // the failure is collected by whoever reads
  for (std::size_t i = 0; i < values.size(); ++i)
    if (mask[i] == 0) values[i] = std::nan("");
}

/// Grids whose header forgot to name the nodata value still use the customary ones.
void RasterSource::drop_undeclared(std::vector<double>& values) {
  int declared = 0;
  band_->GetNoDataValue(&declared);
  for (double& value : values) {
    const bool customary = declared == 0 && (value == -9999 || value == -32768);
    if (!customary && !beyond_all_heights(value)) continue;
    value = std::nan("");
    ++undeclared_;
  }
}

void RasterSource::refuse_infinite(const std::vector<double>& values, int column, int line, int columns) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isinf(values[i])) continue;
    const int c = column + static_cast<int>(i % static_cast<std::size_t>(columns)),
              l = line + static_cast<int>(i / static_cast<std::size_t>(columns));
    const auto& g = transform_;
    throw DataError(
        {fmt::format("{}: column {}, line {} (x {:.2f}, y {:.2f}) is infinite", file_.string(), c + 1, l + 1,
                     g[0] + g[1] * (c + 0.5) + g[2] * (l + 0.5), g[3] + g[4] * (c + 0.5) + g[5] * (l + 0.5)),
         "no elevation or thickness is",
         fmt::format("Make such cells nodata: gdal_calc.py -A {} --calc=\"where(isfinite(A),A,-9999)\" "
                     "--NoDataValue=-9999 --outfile={}",
                     file_.string(), mended(file_, "_finite"))});
  }
}

Warped::Warped(RasterSource& source, const OGRSpatialReference& srs) {
  auto cells = std::make_unique<PlainCells>(source);
  grid_ = grid_around(source, *cells, srs);
  cells_ = Dataset(cells.release());
  warped_ = warp(source, *cells_, grid_, srs);
}

Warped::~Warped() = default;

std::vector<double> Warped::read(int column, int line, int columns, int lines) {
  const QuietErrors errors;
  std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines));
  const bool read = warped_->GetRasterBand(1)->RasterIO(GF_Read, column, line, columns, lines, values.data(), columns,
                                                        lines, GDT_Float64, 0, 0, nullptr) == CE_None;
  if (const auto fault = static_cast<PlainCells&>(*cells_).take_fault()) std::rethrow_exception(fault);
  if (!read || errors.failed())
    throw DataError({static_cast<PlainCells&>(*cells_).file().string() + ": cannot be reprojected", errors.text(),
                     "Reproject it beforehand: gdalwarp -t_srs EPSG:<code>"});
  return values;
}

}  // namespace talus::gdal
