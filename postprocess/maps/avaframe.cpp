// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/avaframe.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include "common/gis/geotiff.hpp"
#include "common/map/slope.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

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

class AvaframeWriter : public Writer {
 public:
  std::string name() const override { return "AvaFrame"; }
  std::vector<std::string_view> words() const override { return {"avaframe-tif", "avaframe-asc"}; }
  bool wanted(const Job& job) const override {
    return job.options.writes("avaframe-tif") || job.options.writes("avaframe-asc");
  }
  std::vector<std::string> names() const override { return {"maps/avaframe/rel*_mpm*"}; }
  Files write(const Job& job) const override {
    const AvaFrameFormat format = job.options.writes("avaframe-asc") ? AvaFrameFormat::asc : AvaFrameFormat::tif;
    return write_avaframe(folder_of(job, "maps/avaframe"), job.run, settings_text(job.run, job.file), format);
  }
};

}  // namespace

std::shared_ptr<Writer> avaframe_writer() { return std::make_shared<AvaframeWriter>(); }

std::string settings_text(const Run& run, const fs::path& run_file) {
  std::string text;
  const std::string whole = text_if_there(run_file.parent_path() / "solve.used.toml").value_or("");
  std::istringstream used(is_used_recipe_of(whole, fact(run.summary.provenance, run_id)) ? whole : "");
  for (std::string line; std::getline(used, line);) {
    if (!line.empty() && line[0] != '#') text += line + "\n";
  }
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
