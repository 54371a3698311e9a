#include "postprocess/maps/netcdf.hpp"

#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"
#include "postprocess/maps/cf_projection.hpp"
#include "postprocess/maps/fields.hpp"

namespace talus::postprocess {
namespace {

constexpr double fill = -9999;

/// A NetCDF file made in memory; every call is checked. In memory, because a full disk leaves the library unable to
/// close its file, and crashing: the bytes are written by write_text(), which knows what to say.
class Nc {
 public:
  explicit Nc(std::filesystem::path shown) : shown_(std::move(shown)) {
    check(nc_create_mem(shown_.filename().c_str(), NC_NETCDF4, 0, &id_), "it cannot be created");
  }
  Nc(const Nc&) = delete;
  Nc& operator=(const Nc&) = delete;
  ~Nc() {
    if (id_ >= 0) nc_abort(id_);
  }
  std::string close() {
    NC_memio image{};
    check(nc_close_memio(std::exchange(id_, -1), &image), "closing it");
    const std::unique_ptr<void, decltype(&std::free)> owner(image.memory, &std::free);
    return {static_cast<const char*>(image.memory), image.size};
  }

  int dimension(const char* name, std::size_t size) {
    int dimension = 0;
    check(nc_def_dim(id_, name, size, &dimension), name);
    return dimension;
  }
  int variable(const char* name, nc_type type, const std::vector<int>& dimensions) {
    int variable = 0;
    check(nc_def_var(id_, name, type, static_cast<int>(dimensions.size()), dimensions.data(), &variable), name);
    return variable;
  }
  /// A map (or maps over time): chunked by map, compressed, with fill value.
  int field(const char* name, const std::vector<int>& dimensions, std::size_t rows, std::size_t columns) {
    const int id = variable(name, NC_DOUBLE, dimensions);
    std::vector<std::size_t> chunk(dimensions.size(), 1);
    chunk[dimensions.size() - 2] = std::min<std::size_t>(rows, 512);
    chunk[dimensions.size() - 1] = std::min<std::size_t>(columns, 512);
    check(nc_def_var_chunking(id_, id, NC_CHUNKED, chunk.data()), name);
    check(nc_def_var_deflate(id_, id, 1, 1, 4), name);
    check(nc_def_var_fill(id_, id, NC_FILL, &fill), name);
    return id;
  }
  void text(int variable, const char* name, const std::string& value) {
    check(nc_put_att_text(id_, variable, name, value.size(), value.data()), name);
  }
  void numbers(int variable, const char* name, const std::vector<double>& values) {
    check(nc_put_att_double(id_, variable, name, NC_DOUBLE, values.size(), values.data()), name);
  }
  void put(int variable, const std::vector<double>& values) {
    check(nc_put_var_double(id_, variable, values.data()), "values");
  }
  void put_map(int variable, std::size_t time, std::size_t rows, std::size_t columns,
               const std::vector<double>& values) {
    const std::size_t start[] = {time, 0, 0}, count[] = {1, rows, columns};
    check(nc_put_vara_double(id_, variable, start, count, values.data()), "values");
  }
  void end_definitions() { check(nc_enddef(id_), "header"); }

 private:
  void check(int status, const char* doing) {
    if (status != NC_NOERR) throw DataError(write_fault(shown_, fmt::format("{}: {}", doing, nc_strerror(status))));
  }

  std::filesystem::path shown_;
  int id_ = -1;
};

std::vector<double> filled(std::vector<double> values, const std::vector<char>& inside) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!inside[i] || std::isnan(values[i])) values[i] = fill;
  }
  return values;
}

struct Axes {
  int x, y;  // dimensions
  int x_variable, y_variable;
};

Axes define_axes(Nc& nc, const MapGrid& grid) {
  Axes axes{};
  axes.y = nc.dimension("y", static_cast<std::size_t>(grid.rows));
  axes.x = nc.dimension("x", static_cast<std::size_t>(grid.columns));
  axes.x_variable = nc.variable("x", NC_DOUBLE, {axes.x});
  axes.y_variable = nc.variable("y", NC_DOUBLE, {axes.y});
  for (const bool is_x : {true, false}) {
    const int id = is_x ? axes.x_variable : axes.y_variable;
    nc.text(id, "standard_name", is_x ? "projection_x_coordinate" : "projection_y_coordinate");
    nc.text(id, "long_name", is_x ? "easting of the cell centre" : "northing of the cell centre");
    nc.text(id, "units", "m");
    nc.text(id, "axis", is_x ? "X" : "Y");
  }
  return axes;
}

void define_crs(Nc& nc, const MapGrid& grid) {
  const int id = nc.variable("crs", NC_INT, {});
  const auto projection = cf_projection(grid.crs_wkt);
  if (!projection.grid_mapping_name.empty()) nc.text(id, "grid_mapping_name", projection.grid_mapping_name);
  for (const auto& [name, values] : projection.numbers) nc.numbers(id, name.c_str(), values);
  nc.text(id, "crs_wkt", grid.crs_wkt);
  nc.text(id, "spatial_ref", grid.crs_wkt);  // GDAL's name for it
  nc.text(id, "GeoTransform", fmt::format("{} {} 0 {} 0 {}", grid.west, grid.cell, grid.north(), -grid.cell));
}

void describe_file(Nc& nc, const Run& run, const NetcdfNotes& notes) {
  const auto& s = run.summary;
  nc.text(NC_GLOBAL, "Conventions", "CF-1.8");
  nc.text(NC_GLOBAL, "title", s.title);
  nc.text(NC_GLOBAL, "institution", notes.institution.empty() ? "not stated" : notes.institution);
  nc.text(NC_GLOBAL, "source",
          fmt::format("Talus {}, material point method, {} precision on {}", s.version, s.precision, s.on));
  nc.text(NC_GLOBAL, "history",
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}: {}", fmt::gmtime(std::time(nullptr)), notes.command_line));
  nc.text(NC_GLOBAL, "comment",
          "Thickness is vertical (along the plumb line), not normal to the slope, and counts released volume. Cells "
          "outside the "
          "computed domain hold the fill value; inside it 0 means that nothing is there.");
}

/// What every map variable says of itself.
void describe_field(Nc& nc, int id, const Field& field, bool has_crs) {
  nc.text(id, "long_name", field.long_name);
  nc.text(id, "units", field.unit);
  if (*field.cell_methods != '\0') nc.text(id, "cell_methods", field.cell_methods);
  if (has_crs) nc.text(id, "grid_mapping", "crs");
}

struct Variable {
  int id;
  const Field* field;
};

const Field start_field{
    "initial_thickness", &RunMaps::initial_thickness, "m", "thickness at the start, vertical", "", true};
const Field bed_field{"bed_elevation", &RunMaps::terrain, "m", "elevation of the bed", "", false};
const Field thickness_field{"thickness", nullptr, "m", "thickness, vertical", "time: point", true};

/// The variables of one file, defined first and filled afterwards.
struct Layout {
  Axes axes{};
  std::vector<Variable> maps;
  int time = -1, thickness = -1;
};

Layout define(Nc& nc, const Run& run) {
  const auto& grid = run.maps.grid;
  const auto rows = static_cast<std::size_t>(grid.rows), columns = static_cast<std::size_t>(grid.columns);
  const bool has_crs = !grid.crs_wkt.empty(), has_frames = !run.frames.time.empty();
  Layout layout;
  const int time_dimension = has_frames ? nc.dimension("time", run.frames.time.size()) : -1;
  layout.axes = define_axes(nc, grid);
  if (has_crs) define_crs(nc, grid);
  const auto add = [&](const Field& field) {
    const int id = nc.field(field.name, {layout.axes.y, layout.axes.x}, rows, columns);
    describe_field(nc, id, field, has_crs);
    layout.maps.push_back({id, &field});
  };
  for (const auto& field : product_fields()) add(field);
  add(start_field);
  add(bed_field);
  if (!has_frames) return layout;
  layout.time = nc.variable("time", NC_DOUBLE, {time_dimension});
  nc.text(layout.time, "long_name", "time since the start of the failure");
  nc.text(layout.time, "units", "s");
  nc.text(layout.time, "axis", "T");
  layout.thickness = nc.field(thickness_field.name, {time_dimension, layout.axes.y, layout.axes.x}, rows, columns);
  describe_field(nc, layout.thickness, thickness_field, has_crs);
  return layout;
}

void fill_in(Nc& nc, const Layout& layout, const Run& run) {
  const auto& grid = run.maps.grid;
  std::vector<double> x, y;
  for (int i = 0; i < grid.columns; ++i) x.push_back(grid.x(i));
  for (int i = 0; i < grid.rows; ++i) y.push_back(grid.y(i));
  nc.put(layout.axes.x_variable, x);
  nc.put(layout.axes.y_variable, y);
  const auto inside = inside_domain(run.maps);
  for (const auto& [id, field] : layout.maps) nc.put(id, filled(field_raster(run.maps, *field).values, inside));
  if (layout.time >= 0) nc.put(layout.time, run.frames.time);
  for (std::size_t i = 0; i < run.frames.time.size(); ++i) {
    nc.put_map(layout.thickness, i, y.size(), x.size(), filled(run.frames.thickness[i], inside));
  }
}

}  // namespace

void write_netcdf(const std::filesystem::path& file, const Run& run, const NetcdfNotes& notes) {
  Nc nc(file);
  describe_file(nc, run, notes);
  const auto layout = define(nc, run);
  nc.end_definitions();
  fill_in(nc, layout, run);
  write_text(file, nc.close());
}

}  // namespace talus::postprocess
