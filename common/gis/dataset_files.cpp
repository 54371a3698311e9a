// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/dataset_files.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"
#include "common/recipe/vector_source.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

/// Formats that are read whole when they are opened, and lie in one file but for a projection beside it.
constexpr std::array<std::string_view, 6> costly{"XYZ", "CSV", "GeoJSON", "KML", "GML", "GPX"};

bool cheap_to_open(const fs::path& file) {
  GDALDriverH driver = GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR, nullptr, nullptr);
  return driver != nullptr && std::find(costly.begin(), costly.end(), GDALGetDescription(driver)) == costly.end();
}

std::vector<fs::path> files_of_dataset(const fs::path& file) {
  try {
    gdal::require_local(file);
  } catch (const DataError&) {
    return {};  // whoever reads it says so
  }
  const gdal::QuietErrors errors;
  if (!cheap_to_open(file)) return {};
  const gdal::Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!dataset) return {};
  char** names = dataset->GetFileList();
  std::vector<fs::path> files;
  for (char** name = names; name != nullptr && *name != nullptr; ++name) files.emplace_back(*name);
  CSLDestroy(names);
  return files;
}

/// dem.prj or dem.PRJ beside dem.asc: read with grids and tables that GDAL does not open by itself.
void add_projection(const fs::path& file, std::vector<fs::path>& files) {
  for (const char* extension : {".prj", ".PRJ"}) {
    const fs::path beside = fs::path(file).replace_extension(extension);
    std::error_code none_there;
    if (fs::is_regular_file(beside, none_there)) files.push_back(beside);
  }
}

/// A name that only GDAL knows (NETCDF:file.nc:z, /vsizip/...) is no file.
bool is_plain(const fs::path& file) { return file.is_absolute() && !file.native().starts_with("/vsi"); }

}  // namespace

std::vector<fs::path> with_sidecars(const std::vector<fs::path>& files) {
  std::vector<fs::path> all;
  const auto add = [&](const fs::path& file) {
    if (is_plain(file) && std::find(all.begin(), all.end(), file) == all.end()) all.push_back(file);
  };
  for (const fs::path& source : files) {
    const fs::path file = vector_source(source).file;
    add(file);
    std::vector<fs::path> parts = files_of_dataset(file);
    if (is_plain(file)) add_projection(file, parts);
    for (const fs::path& part : parts) add(part.lexically_normal());
  }
  return all;
}

}  // namespace talus
