// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters for tests, and CRS texts by EPSG code.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <string>

#include <cpl_minixml.h>
#include <ogr_spatialref.h>

#include "common/map/raster.hpp"

namespace talus::test {

/// WKT2 of an EPSG code, written as read_raster writes it.
inline std::string epsg(int code) {
  OGRSpatialReference srs;
  if (srs.importFromEPSG(code) != OGRERR_NONE)
    throw std::runtime_error("PROJ does not know EPSG:" + std::to_string(code));
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  char* wkt = nullptr;
  srs.exportToWkt(&wkt, options);
  std::string text = wkt;
  CPLFree(wkt);
  return text;
}

/// Values between 0 and 50, from a seed.
inline Raster random_raster(const MapGrid& grid, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> value(0, 50);
  Raster raster{grid, std::vector<double>(grid.count())};
  for (double& cell : raster.values) cell = value(random);
  return raster;
}

inline Raster small_raster(const MapGrid& grid, std::vector<double> values) { return {grid, std::move(values)}; }

inline double volume(const Raster& raster) {
  double sum = 0;
  for (const double value : raster.values)
    if (!std::isnan(value)) sum += value;
  return sum * raster.grid.cell * raster.grid.cell;
}

/// A VRT that stores the cells of the GeoTIFF `file` south first, line by line.
inline std::string south_first_vrt(const std::string& file, const MapGrid& grid) {
  const auto number = [](double value) { return std::to_string(value); };
  const std::string columns = std::to_string(grid.columns), rows = std::to_string(grid.rows);
  std::string text = "<VRTDataset rasterXSize=\"" + columns + "\" rasterYSize=\"" + rows + "\"><SRS>" + grid.crs_wkt +
                     "</SRS><GeoTransform>" + number(grid.west) + ", " + number(grid.cell) + ", 0, " +
                     number(grid.south) + ", 0, " + number(grid.cell) +
                     "</GeoTransform><VRTRasterBand dataType=\"Float64\" band=\"1\"><NoDataValue>-9999</NoDataValue>";
  for (int row = 0; row < grid.rows; ++row) {
    const auto line = [&](const char* name, int at) {
      return std::string("<") + name + " xOff=\"0\" yOff=\"" + std::to_string(at) + "\" xSize=\"" + columns +
             "\" ySize=\"1\"/>";
    };
    text += "<SimpleSource><SourceFilename relativeToVRT=\"1\">" + file + "</SourceFilename>" +
            line("SrcRect", grid.rows - 1 - row) + line("DstRect", row) + "</SimpleSource>";
  }
  return text + "</VRTRasterBand></VRTDataset>";
}

/// Same cells, same bits; NaN equals NaN.
inline bool identical(const Raster& a, const Raster& b) {
  const bool same_grid = a.grid.columns == b.grid.columns && a.grid.rows == b.grid.rows && a.grid.west == b.grid.west &&
                         a.grid.south == b.grid.south && a.grid.cell == b.grid.cell;
  if (!same_grid || a.values.size() != b.values.size()) return false;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    if (a.values[i] != b.values[i] && !(std::isnan(a.values[i]) && std::isnan(b.values[i]))) return false;
  return true;
}

struct DestroyXml {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};
using XmlDocument = std::unique_ptr<CPLXMLNode, DestroyXml>;

inline XmlDocument parsed(const std::filesystem::path& file) { return XmlDocument(CPLParseXMLFile(file.c_str())); }

}  // namespace talus::test
