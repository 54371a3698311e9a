// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/geotiff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/gis/geotiff.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {

namespace {

const char* meaning_of_nodata(bool zero_inside) {
  return zero_inside ? "outside the computed domain" : "outside the computed domain, or never reached";
}

class GeotiffWriter : public Writer {
 public:
  std::string name() const override { return "GeoTIFF"; }
  std::vector<std::string> names() const override { return names_of_maps(".tif"); }
  std::vector<std::string> outdated() const override { return {}; }
  Files write(const Job& job) const override { return write_geotiffs(folder_of(job, "maps"), job.run); }
};

}  // namespace

std::shared_ptr<Writer> geotiff_writer() { return std::make_shared<GeotiffWriter>(); }

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
    put(field.product.title, field.unit, field.product.zero_inside, field_raster(run.maps, field));
  for (const auto& [release, values] : run.maps.deposit_of)
    put("deposit thickness of one release, vertical", "m", true, values_raster(run.maps, values, true));
  return files;
}

}  // namespace talus::postprocess
