// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "data_samples/write_sample.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <memory>

#include "common/stage/stage.hpp"

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

}  // namespace

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

}  // namespace talus::samples
