// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-make-terrain KIND --out DIR: writes one of the synthetic terrains; paths go to stdout.
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <CLI/CLI.hpp>

#include "common/error.hpp"
#include "common/stage/stage.hpp"
#include "data_samples/terrains.hpp"

namespace talus::samples {
namespace {

void require(bool done, const std::filesystem::path& file) {
  if (!done)
    throw DataError(Fault{file.string() + ": cannot be written", CPLGetLastErrorMsg(),
                          "Check that the folder is writable and the disk has room"});
}

/// Float32 and compressed: values are rounded to cm, so that a few kB hold them.
void write_raster(const std::filesystem::path& file, const Raster& raster) {
  const MapGrid& grid = raster.grid;
  PendingFile pending(file);
  CPLStringList options;
  for (const char* option : {"COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=9"}) options.AddString(option);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  std::unique_ptr<GDALDataset> dataset(
      driver->Create(pending.path().c_str(), grid.columns, grid.rows, 1, GDT_Float32, options.List()));
  require(dataset != nullptr, file);
  double transform[] = {grid.west, grid.cell, 0, grid.north(), 0, -grid.cell};
  OGRSpatialReference crs;
  require(crs.importFromEPSG(crs_epsg) == OGRERR_NONE && dataset->SetSpatialRef(&crs) == CE_None &&
              dataset->SetGeoTransform(transform) == CE_None,
          file);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  band.SetNoDataValue(-9999);
  for (int row = 0; row < grid.rows; ++row) {
    std::vector<double> line(raster.values.begin() + row * grid.columns,
                             raster.values.begin() + (row + 1) * grid.columns);
    for (double& value : line) value = std::isnan(value) ? -9999 : value;
    require(band.RasterIO(GF_Write, 0, grid.rows - 1 - row, grid.columns, 1, line.data(), grid.columns, 1, GDT_Float64,
                          0, 0) == CE_None,
            file);
  }
  CPLErrorReset();
  dataset.reset();
  require(CPLGetLastErrorType() != CE_Failure, file);
  pending.commit();
}

std::string geojson(const std::vector<Feature>& features) {
  std::string text = fmt::format(
      "{{\"type\": \"FeatureCollection\",\n\"crs\": {{\"type\": \"name\", \"properties\": {{\"name\": "
      "\"urn:ogc:def:crs:EPSG::{}\"}}}},\n"
      "\"features\": [",
      crs_epsg);
  for (const Feature& feature : features) {
    const std::string thickness = feature.thickness < 0 ? "" : fmt::format(", \"thickness\": {:g}", feature.thickness);
    text += fmt::format(
        "{}\n{{\"type\": \"Feature\", \"properties\": {{\"name\": \"{}\"{}}},\n \"geometry\": {{\"type\": \"Polygon\", "
        "\"coordinates\": [[",
        &feature == features.data() ? "" : ",", feature.name, thickness);
    for (const auto& [x, y] : feature.outline) text += fmt::format("[{:.2f}, {:.2f}], ", x, y);
    text += fmt::format("[{:.2f}, {:.2f}]]]}}}}", feature.outline.front()[0], feature.outline.front()[1]);
  }
  return text + "\n]}\n";
}

/// Writes all files of a sample into `folder`, each aside and renamed; returns their paths. Throws DataError.
std::vector<std::filesystem::path> write_sample(const std::filesystem::path& folder, const Sample& sample) {
  GDALAllRegister();
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> files;
  for (const auto& [stem, raster] : sample.rasters) {
    files.push_back(folder / (stem + ".tif"));
    write_raster(files.back(), raster);
  }
  for (const auto& [stem, features] : sample.outlines) {
    files.push_back(folder / (stem + ".geojson"));
    write_text(files.back(), geojson(features));
  }
  return files;
}

/// The terrain of a kind, with cells of this size [m], laid on the map. Throws RecipeError where it cannot be laid so.
using Maker = std::function<Sample(double cell, const Pose& pose)>;

Maker fixed(Sample (*made)(double cell)) {
  return [made](double cell, const Pose& pose) {
    if (pose.mirrored || pose.turned_deg != 0)
      throw RecipeError({"this terrain cannot be mirrored or turned",
                         "rough-slope, bent-gully, cliff-bench, thinning-slide and weathered-slope alone are "
                         "given on axes of their own",
                         "Leave out --mirror and --turn, or make one of those"});
    return made(cell);
  };
}
Maker laid(HardTerrain (*terrain)()) {
  return [terrain](double cell, const Pose& pose) { return LaidTerrain(terrain(), cell, pose).sample(); };
}

const std::map<std::string, Maker> kinds{{"bent-gully", laid(bent_gully)},
                                         {"cliff-bench", laid(cliff_bench)},
                                         {"inclined-plane", fixed(inclined_plane)},
                                         {"parabolic-chute", fixed(parabolic_chute)},
                                         {"raw-valley", fixed([](double cell) { return raw_valley(cell, 1); })},
                                         {"rock-slope", fixed(rock_slope)},
                                         {"rough-slope", laid(rough_slope)},
                                         {"thinning-slide", laid(thinning_slide)},
                                         {"valley", fixed(valley)},
                                         {"weathered-slope", laid(weathered_slope)}};

std::string names() {
  std::string all;
  for (const auto& [name, maker] : kinds) all += (all.empty() ? "" : ", ") + name;
  return all;
}

}  // namespace
}  // namespace talus::samples

int main(int argc, char** argv) {
  using namespace talus::samples;
  CLI::App app{"Makes a small synthetic terrain: elevation models, outlines and release thickness.",
               "talus-make-terrain"};
  std::string kind, out;
  double cell = 10;
  app.add_option("kind", kind, "One of " + names())
      ->required()
      ->type_name("KIND")
      ->check(CLI::IsMember(kinds).description(""));
  app.add_option("--out", out, "Folder to write to, made if missing")->required()->type_name("DIR");
  app.add_option("--cell", cell, "Cell size [m], 0.5 to 50 (default: 10)")
      ->type_name("M")
      ->check(CLI::Range(0.5, 50.0).description(""));
  Pose pose;
  app.add_flag("--mirror", pose.mirrored, "Left for right, seen down the slope");
  app.add_option("--turn", pose.turned_deg, "Counter-clockwise [degrees], -360 to 360 (default: 0)")
      ->type_name("DEG")
      ->check(CLI::Range(-360.0, 360.0).description(""));
  app.set_version_flag("--version", "talus-make-terrain " + talus::version(), "Print the version and its commit");
  try {
    app.parse(argc, argv);
    for (const auto& file : write_sample(out, kinds.at(kind)(cell, pose))) std::cout << file.string() << "\n";
  } catch (const CLI::ParseError& fault) {
    return app.exit(fault) == 0 ? 0 : static_cast<int>(talus::ExitCode::recipe);
  } catch (const talus::Error& error) {
    std::cerr << "talus-make-terrain: " << error.what() << "\n";
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::cerr << "talus-make-terrain: " << error.what() << "\n";
    return static_cast<int>(talus::ExitCode::data);
  }
  return 0;
}
