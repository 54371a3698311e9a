// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/netcdf.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/maps/nc_file.hpp"
#include "postprocess/maps/nc_grid.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

std::vector<double> filled(std::vector<double> values, const std::vector<char>& inside) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!inside[i] || std::isnan(values[i])) values[i] = nc_fill;
  }
  return values;
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
  const std::string id = fact(s.provenance, run_id);
  nc.text(NC_GLOBAL, "run_id", id.empty() ? "not known" : id);
  if (const std::string accepted = accepted_line(s.findings); !accepted.empty())
    nc.text(NC_GLOBAL, "accepted", accepted);
  if (!s.sanity.words.empty()) nc.text(NC_GLOBAL, "sanity", s.sanity.words);
  nc.text(NC_GLOBAL, "comment",
          "Thickness is vertical (along the plumb line), not normal to the slope, and counts released volume. Cells "
          "outside the computed domain hold the fill value; inside it 0 means that nothing is there.");
}

/// A map variable: what it says of itself, and its values.
struct MapVariable {
  std::string name, long_name, units, cell_methods;
  const std::vector<double>* values;
  bool zero_inside;
};

std::vector<MapVariable> map_variables(const RunMaps& maps) {
  std::vector<MapVariable> all;
  for (const auto& [name, values, unit, meaning, optional, product, layer] : map_fields) {
    if (product.netcdf_name[0] == '\0' || (maps.*values).empty()) continue;
    all.push_back(
        {product.netcdf_name, product.title, unit, product.cell_methods, &(maps.*values), product.zero_inside});
  }
  for (const auto& [release, values] : maps.deposit_of) {
    std::string name = "deposit_thickness_" + nc_name(release);
    const auto taken = [&](const MapVariable& other) { return other.name == name; };
    while (std::any_of(all.begin(), all.end(), taken)) name += "_";  // "a-b" after "a b"
    all.push_back(
        {name, "deposit thickness at the end of release " + release + ", vertical", "m", "area: mean", &values, true});
  }
  return all;
}

int define_map(Nc& nc, const MapVariable& map, const std::vector<int>& dimensions, const MapGrid& grid) {
  const int id = nc.field(map.name.c_str(), dimensions, static_cast<std::size_t>(grid.rows),
                          static_cast<std::size_t>(grid.columns));
  nc.text(id, "long_name", map.long_name);
  nc.text(id, "units", map.units);
  if (!map.cell_methods.empty()) nc.text(id, "cell_methods", map.cell_methods);
  if (!grid.crs_wkt.empty()) nc.text(id, "grid_mapping", "crs");
  return id;
}

/// The variables of one file, defined first and filled afterwards.
struct Layout {
  NcAxes axes;
  std::vector<MapVariable> maps;
  std::vector<int> ids;
  int time = -1, thickness = -1;
};

Layout define(Nc& nc, const Run& run, const NetcdfNotes& notes) {
  const auto& grid = run.maps.grid;
  Layout layout;
  const bool has_frames = !run.frames.time.empty();
  const int time = has_frames ? nc.dimension("time", run.frames.time.size()) : -1;
  layout.axes = define_axes(nc, grid);
  const int y = layout.axes.y.dimension, x = layout.axes.x.dimension;
  if (!grid.crs_wkt.empty()) define_crs(nc, grid);
  layout.maps = map_variables(run.maps);
  for (const auto& map : layout.maps) layout.ids.push_back(define_map(nc, map, {y, x}, grid));
  if (!has_frames) return layout;
  layout.time = define_time(nc, time, notes.start);
  if (notes.start.empty())
    nc.text(layout.time, "comment", "the date is nominal: the run does not say when the failure began");
  const MapVariable thickness{"thickness", "thickness, vertical", "m", "area: mean time: point", nullptr, true};
  layout.thickness = define_map(nc, thickness, {time, y, x}, grid);
  return layout;
}

void fill_in(Nc& nc, const Layout& layout, const Run& run) {
  const auto& grid = run.maps.grid;
  fill_axes(nc, layout.axes, grid);
  const auto inside = inside_domain(run.maps);
  for (std::size_t i = 0; i < layout.maps.size(); ++i) {
    const auto& map = layout.maps[i];
    nc.put(layout.ids[i], filled(values_raster(run.maps, *map.values, map.zero_inside).values, inside));
  }
  if (layout.time >= 0) nc.put(layout.time, run.frames.time);
  for (std::size_t i = 0; i < run.frames.time.size(); ++i) {
    nc.put_map(layout.thickness, i, static_cast<std::size_t>(grid.rows), static_cast<std::size_t>(grid.columns),
               filled(run.frames.thickness[i], inside));
  }
}

class NetcdfWriter : public Writer {
 public:
  std::string name() const override { return "NetCDF"; }
  std::vector<std::string> names() const override { return {"maps/results.nc"}; }
  std::vector<std::string> outdated() const override { return {}; }
  Files write(const Job& job) const override {
    const NetcdfNotes notes{job.options.institution, job.command_line, job.options.start_time};
    Files files{folder_of(job, "maps") / "results.nc"};
    write_netcdf(files.front(), job.run, notes);
    return files;
  }
};

}  // namespace

std::shared_ptr<Writer> netcdf_writer() { return std::make_shared<NetcdfWriter>(); }

void write_netcdf(const std::filesystem::path& file, const Run& run, const NetcdfNotes& notes) {
  Nc nc(file);
  describe_file(nc, run, notes);
  const auto layout = define(nc, run, notes);
  nc.end_definitions();
  fill_in(nc, layout, run);
  write_text(file, nc.close());
}

}  // namespace talus::postprocess
