#include "postprocess/maps/geotiff.hpp"

#include <fmt/format.h>

#include "common/raster/raster_io.hpp"
#include "postprocess/maps/fields.hpp"

namespace talus::postprocess {

std::vector<std::filesystem::path> write_geotiffs(const std::filesystem::path& folder, const Run& run) {
  std::vector<std::filesystem::path> files;
  for (const auto& field : product_fields()) {
    RasterTags tags{fmt::format("{} [{}]", field.long_name, field.unit), field.unit, {}};
    tags.metadata = {
        {"TITLE", run.summary.title},
        {"SCENE", run.summary.scene},
        {"QUANTITY", field.long_name},
        {"THICKNESS_CONVENTION", "vertical thickness, measured along the plumb line (not normal to the slope)"},
        {"FLOW_THRESHOLD_M", fmt::format("{}", run.maps.threshold)},
        {"TIME_END_S", fmt::format("{}", run.summary.time_end)},
        {"NODATA_MEANING",
         field.zero_inside ? "outside the computed domain" : "outside the computed domain, or never reached"},
        {"SOURCE", "Talus " + run.summary.version}};
    files.push_back(folder / (std::string(field.name) + ".tif"));
    write_cog(files.back(), field_raster(run.maps, field), tags);
  }
  return files;
}

}  // namespace talus::postprocess
