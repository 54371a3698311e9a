// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/geotiff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/gis/geotiff.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {

namespace {

std::string meaning_of_nodata(bool zero_inside, Outside outside) {
  if (!zero_inside) return "outside the computed domain, or never reached";
  return outside == Outside::zero ? "not used: 0 outside the computed domain too" : "outside the computed domain";
}

}  // namespace

std::vector<std::filesystem::path> write_geotiffs(const std::filesystem::path& folder, const Run& run,
                                                  Outside outside) {
  std::vector<std::filesystem::path> files;
  const auto put = [&](const std::string& name, const char* long_name, const char* unit, bool zero_inside,
                       Raster raster) {
    if (zero_inside && outside == Outside::zero)
      std::replace_if(
          raster.values.begin(), raster.values.end(), [](double v) { return std::isnan(v); }, 0.0);
    RasterTags tags{fmt::format("{} [{}]", long_name, unit), unit, {}};
    tags.metadata = {
        {"TITLE", run.summary.title},
        {"SCENE", run.summary.scene},
        {"RUN_ID", fact(run.summary.provenance, run_id)},
        {"QUANTITY", long_name},
        {"THICKNESS_CONVENTION", "vertical thickness, measured along the plumb line (not normal to the slope)"},
        {"FLOW_THRESHOLD_M", fmt::format("{}", run.maps.threshold)},
        {"TIME_END_S", fmt::format("{}", run.summary.time_end)},
        {"NODATA_MEANING", meaning_of_nodata(zero_inside, outside)},
        {"SOURCE", "Talus " + run.summary.version}};
    if (const std::string accepted = accepted_words(run.summary); !accepted.empty())
      tags.metadata.emplace_back("ACCEPTED", accepted);
    if (!run.summary.sanity.words.empty()) tags.metadata.emplace_back("SANITY", run.summary.sanity.words);
    files.push_back(folder / (name + ".tif"));
    write_cog(files.back(), raster, tags);
  };
  for (const MapField& field : product_fields(run.maps))
    put(field.name, field.product.title, field.unit, field.product.zero_inside, field_raster(run.maps, field));
  const std::vector<std::string> words = file_words(run.maps.deposit_of);
  for (std::size_t r = 0; r < words.size(); ++r) {
    const std::vector<double>& values = run.maps.deposit_of[r].second;
    put("deposit_thickness_" + words[r], "deposit thickness of one release, vertical", "m", true,
        values_raster(run.maps, values, true));
  }
  return files;
}

}  // namespace talus::postprocess
