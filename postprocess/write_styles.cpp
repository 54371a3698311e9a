// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-write-styles DIR: the styles for QGIS that lie beside every run's maps, for rasters from elsewhere. It is part
// of the build and is not installed. The classes are those of the maps: DIR/thick for deposits of 12 m and more,
// DIR/thin below that.
#include <filesystem>
#include <iostream>

#include "common/error.hpp"
#include "common/qgis/style.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"

namespace {

namespace fs = std::filesystem;
using namespace talus;

/// The largest values of a slide of this size: thickness [m], speed [m/s], pressure [kPa], duration [s].
struct Extent {
  const char* folder;
  double thickness, speed, pressure, duration;
};
constexpr Extent extents[] = {{"thick", 200, 150, 20000, 300}, {"thin", 10, 50, 500, 120}};

double largest_of(const MapField& field, const Extent& extent) {
  switch (field.product.classes) {
    case MapClasses::speed: return extent.speed;
    case MapClasses::pressure: return extent.pressure;
    case MapClasses::time: return extent.duration;
    case MapClasses::share: return 1;
    case MapClasses::thickness: break;
  }
  return extent.thickness;
}

void write_styles(const fs::path& folder, const Extent& extent) {
  make_folder(folder);
  RunMaps maps;
  for (const MapField& field : map_fields) maps.*(field.values) = {largest_of(field, extent)};
  for (const MapField& field : map_fields) {
    if (field.product.legend[0] == '\0') continue;
    const std::string name = field.name;
    std::cout << write_qgis_style(folder / (name + ".tif"), postprocess::map_style(name, maps, {})).string() << "\n";
  }
  const RasterStyle difference = postprocess::map_style("difference", maps, {});
  std::cout << write_qgis_style(folder / "difference.tif", difference).string() << "\n";
  std::cout << write_qgis_hillshade_style(folder / "terrain.tif").string() << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: talus-write-styles DIR\n";
    return static_cast<int>(ExitCode::recipe);
  }
  try {
    for (const Extent& extent : extents) write_styles(fs::path(argv[1]) / extent.folder, extent);
  } catch (const Error& error) {
    std::cerr << "talus-write-styles: " << error.what() << "\n";
    return static_cast<int>(error.code());
  }
  return 0;
}
