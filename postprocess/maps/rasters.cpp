// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of a run as GeoTIFF, as NetCDF and as AvaFrame reads them.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include "common/map/raster.hpp"
#include "common/stage/files.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/maps/maps.hpp"
#include "postprocess/maps/nc_file.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

const char* meaning_of_nodata(bool zero_inside) {
  return zero_inside ? "outside the computed domain" : "outside the computed domain, or never reached";
}

std::vector<double> filled(std::vector<double> values, const std::vector<char>& inside) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!inside[i] || std::isnan(values[i])) values[i] = nc_fill;
  return values;
}

void describe_run(Nc& nc, const Run& run, const NetcdfNotes& notes) {
  const auto& s = run.summary;
  describe_file(nc, s.title, notes.institution,
                fmt::format("Talus {}, material point method, {} precision on {}", s.version, s.precision, s.on),
                notes.command_line);
  const std::string id = fact(s.provenance, run_id);
  nc.text(NC_GLOBAL, "run_id", id.empty() ? "not known" : id);
  if (const std::string accepted = accepted_line(s.findings); !accepted.empty())
    nc.text(NC_GLOBAL, "accepted", accepted);
  if (!s.sanity.words.empty()) nc.text(NC_GLOBAL, "sanity", s.sanity.words);
  nc.text(NC_GLOBAL, "comment",
          "Thickness is vertical (along the plumb line), not normal to the slope, and counts released volume. Cells "
          "outside the computed domain hold the fill value; inside it 0 means that nothing is there.");
}

struct MapVariable {
  std::string name, long_name, units, cell_methods;
  const std::vector<double>* values;
  bool zero_inside;
};

std::vector<MapVariable> map_variables(const RunMaps& maps) {
  std::vector<MapVariable> all;
  for (const MapField& field : map_fields)
    if (const std::vector<double>& values = maps.*(field.values); field.product.in_netcdf && !values.empty())
      all.push_back({field.netcdf_name(), field.title(), field.unit, field.product.cell_methods, &values,
                     field.product.zero_inside});
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
  const int id = nc.field(map.name.c_str(), dimensions);
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
  for (std::size_t i = 0; i < run.frames.time.size(); ++i)
    nc.put_map(layout.thickness, i, filled(run.frames.thickness[i], inside));
}

struct Product {
  const char* suffix;
  const char* words;
  const char* unit;
  Raster raster;
};

std::vector<Product> products(const RunMaps& maps) {
  return {
      {"ppr", "peak pressure, density times speed squared", "kPa", values_raster(maps, maps.peak_pressure_kPa, true)},
      {"pft", "peak thickness, normal to the slope", "m",
       values_raster(maps, normal_thickness(maps, maps.peak_thickness), true)},
      {"pfv", "peak of the depth-mean speed", "m/s", values_raster(maps, maps.peak_speed, true)}};
}

/// A thickness that is taken for the other one gives another volume: both are named.
RasterTags tags_of(const Run& run, const Product& product) {
  const auto& maps = run.maps;
  const double cell = maps.grid.cell;
  const double released = volume_under(maps.initial_thickness, cell);
  const double misread = volume_under(normal_thickness(maps, maps.initial_thickness), cell);
  RasterTags tags{
      fmt::format("{} [{}]", product.words, product.unit),
      product.unit,
      {{"TITLE", run.summary.title},
       {"RUN_ID", fact(run.summary.provenance, run_id)},
       {"QUANTITY", product.words},
       {"THICKNESS_CONVENTION", "normal to the slope: vertical thickness times the cosine of the bed's slope"},
       {"RELEASE_VOLUME_M3", fmt::format("{:.10g}", released)},
       {"RELEASE_VOLUME_MEANING", "vertical thickness over map area, or normal thickness over the area of the slope"},
       {"RELEASE_VOLUME_IF_NORMAL_WERE_VERTICAL_M3", fmt::format("{:.10g}", misread)},
       {"SOURCE", "Talus " + run.summary.version}}};
  if (const std::string accepted = accepted_line(run.summary.findings); !accepted.empty())
    tags.metadata.emplace_back("ACCEPTED", accepted);
  return tags;
}

/// Esri's ASCII grid, corner by the centre of the cell and nodata as nan, as AvaFrame writes them. Every number has a
/// point: readers take a file that begins with whole numbers for integers, and those know no nan.
void write_ascii_grid(const fs::path& file, const Raster& raster) {
  const auto& grid = raster.grid;
  std::string text = fmt::format("ncols {}\nnrows {}\nxllcenter {}\nyllcenter {}\ncellsize {}\nnodata_value nan\n",
                                 grid.columns, grid.rows, grid.x(0), grid.y(0), grid.cell);
  for (int row = grid.rows - 1; row >= 0; --row) {
    for (int column = 0; column < grid.columns; ++column)
      fmt::format_to(std::back_inserter(text), "{}{:.4f}", column == 0 ? "" : " ", raster.at(column, row));
    text += '\n';
  }
  write_text(file, text);
}

/// Letters, digits, dots and dashes: AvaFrame takes names apart at underscores.
std::string part_of_name(const std::string& name) {
  std::string word = file_word(name);
  std::replace(word.begin(), word.end(), '_', '-');
  return word;
}

char size_letter(double volume) { return volume < 25e3 ? 'S' : volume < 60e3 ? 'M' : 'L'; }

}  // namespace

Writer geotiff_writer() {
  return {.name = "GeoTIFF",
          .names = names_of_maps(".tif"),
          .write = [](const Job& job) { return write_geotiffs(folder_of(job, "maps"), job.run); },
          .outdated = std::vector<std::string>{}};
}

RasterTags plain_tags(const Run& run, const std::string& quantity, const std::string& unit) {
  return {fmt::format("{} [{}]", quantity, unit),
          unit,
          {{"TITLE", run.summary.title},
           {"SCENE", run.summary.scene},
           {"RUN_ID", fact(run.summary.provenance, run_id)},
           {"QUANTITY", quantity},
           {"SOURCE", "Talus " + run.summary.version}}};
}

std::vector<std::string> names_of_maps(const std::string& end) {
  std::vector<std::string> names{"maps/deposit_thickness_*" + end};
  for (const MapField& field : map_fields)
    if (field.product.legend[0] != '\0') names.push_back(fmt::format("maps/{}{}", field.name, end));
  return names;
}

Files geotiff_files(const std::filesystem::path& folder, const RunMaps& maps) {
  Files files;
  for (const MapField& field : product_fields(maps)) files.push_back(folder / (std::string(field.name) + ".tif"));
  for (const std::string& word : file_words(maps.deposit_of))
    files.push_back(folder / ("deposit_thickness_" + word + ".tif"));
  return files;
}

Files write_geotiffs(const std::filesystem::path& folder, const Run& run) {
  const Files files = geotiff_files(folder, run.maps);
  auto file = files.begin();
  const auto put = [&](const char* long_name, const char* unit, bool zero_inside, const Raster& raster) {
    RasterTags tags = plain_tags(run, long_name, unit);
    tags.metadata.insert(
        tags.metadata.end() - 1,
        {{"THICKNESS_CONVENTION", "vertical thickness, measured along the plumb line (not normal to the slope)"},
         {"FLOW_THRESHOLD_M", fmt::format("{}", run.maps.threshold)},
         {"TIME_END_S", fmt::format("{}", run.summary.time_end)},
         {"NODATA_MEANING", meaning_of_nodata(zero_inside)}});
    if (const std::string accepted = accepted_line(run.summary.findings); !accepted.empty())
      tags.metadata.emplace_back("ACCEPTED", accepted);
    if (!run.summary.sanity.words.empty()) tags.metadata.emplace_back("SANITY", run.summary.sanity.words);
    write_cog(*file++, raster, tags);
  };
  for (const MapField& field : product_fields(run.maps))
    put(field.title(), field.unit, field.product.zero_inside, field_raster(run.maps, field));
  for (const auto& [release, values] : run.maps.deposit_of)
    put("deposit thickness of one release, vertical", "m", true, values_raster(run.maps, values, true));
  return files;
}

Writer netcdf_writer() {
  return {
      .name = "NetCDF",
      .names = {"maps/results.nc"},
      .write =
          [](const Job& job) {
            const Files files{folder_of(job, "maps") / "results.nc"};
            write_netcdf(files.front(), job.run, {job.options.institution, job.command_line, job.options.start_time});
            return files;
          },
      .outdated = std::vector<std::string>{}};
}

void write_netcdf(const std::filesystem::path& file, const Run& run, const NetcdfNotes& notes) {
  Nc nc(file);
  describe_run(nc, run, notes);
  const auto layout = define(nc, run, notes);
  nc.end_definitions();
  fill_in(nc, layout, run);
  write_text(file, nc.close());
}

Writer avaframe_writer() {
  return {.name = "AvaFrame",
          .names = {"maps/avaframe/rel*_mpm*"},
          .write =
              [](const Job& job) {
                const bool ascii = job.options.writes("avaframe-asc");
                return write_avaframe(folder_of(job, "maps/avaframe"), job.run, settings_text(job.run, job.file),
                                      ascii ? AvaFrameFormat::asc : AvaFrameFormat::tif);
              },
          .words = {"avaframe-tif", "avaframe-asc"}};
}

std::string settings_text(const Run& run, const fs::path& run_file) {
  std::string text;
  const std::string whole = text_if_there(run_file.parent_path() / "solve.used.toml").value_or("");
  std::istringstream used(is_used_recipe_of(whole, fact(run.summary.provenance, run_id)) ? whole : "");
  for (std::string line; std::getline(used, line);)
    if (!line.empty() && line[0] != '#') text += line + "\n";
  for (const auto& [key, value] : run.summary.provenance) {
    if (key == "command" || key == "hardware" || key == "version") continue;
    if (key == run_id || key == domain_id || key == recipe_of_domain || key == recipe_of_run ||
        key == obstacles_checksum)
      continue;
    const auto checksum = key.starts_with("input ") ? value.find("sha256 ") : std::string::npos;
    text += key + " = " + (checksum == std::string::npos ? value : value.substr(checksum)) + "\n";
  }
  return text;
}

std::string avaframe_name(const Run& run, const std::string& settings) {
  return fmt::format("rel{}_{}_C_{}_{}_mpm", part_of_name(run.summary.scene), sha256_of_text(settings).substr(0, 10),
                     size_letter(run.summary.volume_released), run.maps.eroded_depth.empty() ? "null" : "ent");
}

std::vector<double> normal_thickness(const RunMaps& maps, const std::vector<double>& vertical) {
  auto normal = slope_cosine({maps.grid, maps.terrain});
  std::transform(normal.begin(), normal.end(), vertical.begin(), normal.begin(), std::multiplies<>());
  return normal;
}

std::vector<fs::path> write_avaframe(const fs::path& folder, const Run& run, const std::string& settings,
                                     AvaFrameFormat format) {
  const std::string name = avaframe_name(run, settings);
  std::vector<fs::path> files;
  for (const auto& product : products(run.maps)) {
    const bool ascii = format == AvaFrameFormat::asc;
    files.push_back(folder / fmt::format("{}_{}.{}", name, product.suffix, ascii ? "asc" : "tif"));
    if (ascii)
      write_ascii_grid(files.back(), product.raster);
    else
      write_geotiff(files.back(), product.raster, tags_of(run, product));
  }
  files.push_back(folder / (name + ".txt"));
  write_text(files.back(), settings);
  return files;
}

}  // namespace talus::postprocess
