// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/feature_fields.hpp"

#include <ogrsf_frmts.h>

#include "common/gis/vector_layer.hpp"

namespace talus {

std::vector<std::string> field_names(const std::filesystem::path& source) {
  const gdal::VectorLayer from(source, "");
  const OGRFeatureDefn& layer = *from.layer().GetLayerDefn();
  std::vector<std::string> names;
  for (int i = 0; i < layer.GetFieldCount(); ++i) names.emplace_back(layer.GetFieldDefn(i)->GetNameRef());
  return names;
}

std::vector<TextField> text_fields(const std::filesystem::path& source,
                                   const std::function<bool(std::string_view)>& wanted) {
  const gdal::VectorLayer from(source, "");
  std::vector<TextField> found;
  long long number = 0;
  for (const auto& feature : from.layer()) {
    ++number;
    for (int i = 0; i < feature->GetFieldCount(); ++i) {
      const std::string text = feature->GetFieldAsString(i);
      const char* name = feature->GetFieldDefnRef(i)->GetNameRef();
      if (!text.empty() && wanted(name) && !gdal::is_numeric(*feature, i)) found.push_back({number, name, text});
    }
  }
  return found;
}

}  // namespace talus
