// Metadata items of raster files.
#include <cpl_string.h>

#include <cstdlib>

#include "common/gis/gdal_support.hpp"
#include "common/gis/raster_io.hpp"

namespace talus {

std::optional<double> raster_item(const std::filesystem::path& file, const std::string& name) {
  const gdal::QuietErrors errors;
  const gdal::Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset)
    throw DataError(
        {file.string() + ": not a raster that can be read", errors.text(), "Look at it: gdalinfo " + file.string()});
  const char* text = dataset->GetMetadataItem(name.c_str());
  if (text == nullptr || CPLGetValueType(text) == CPL_VALUE_STRING) return std::nullopt;
  return CPLAtof(text);
}

}  // namespace talus
