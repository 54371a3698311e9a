// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/feature_fields.hpp"

#include <ogrsf_frmts.h>

#include "common/gis/gdal_support.hpp"
#include "common/gis/local_only.hpp"

namespace talus {
namespace {

gdal::Dataset open_fields(const std::filesystem::path& file) {
  gdal::require_local(file);
  const gdal::QuietErrors errors;
  gdal::Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (dataset && dataset->GetLayerCount() > 0) return dataset;
  throw DataError(
      {file.string() + ": not a vector file that can be read", errors.text(), "Look at it: ogrinfo " + file.string()});
}

}  // namespace

std::vector<std::string> field_names(const std::filesystem::path& file) {
  const gdal::Dataset dataset = open_fields(file);
  const OGRFeatureDefn& layer = *dataset->GetLayer(0)->GetLayerDefn();
  std::vector<std::string> names;
  for (int i = 0; i < layer.GetFieldCount(); ++i) names.emplace_back(layer.GetFieldDefn(i)->GetNameRef());
  return names;
}

std::vector<TextField> text_fields(const std::filesystem::path& file,
                                   const std::function<bool(std::string_view)>& wanted) {
  const gdal::Dataset dataset = open_fields(file);
  std::vector<TextField> found;
  long long number = 0;
  for (const auto& feature : *dataset->GetLayer(0)) {
    ++number;
    for (int i = 0; i < feature->GetFieldCount(); ++i) {
      const OGRFieldDefn& field = *feature->GetFieldDefnRef(i);
      if (!feature->IsFieldSetAndNotNull(i) || !wanted(field.GetNameRef())) continue;
      const bool numeric = field.GetType() == OFTInteger || field.GetType() == OFTInteger64 ||
                           field.GetType() == OFTReal ||
                           CPLGetValueType(feature->GetFieldAsString(i)) != CPL_VALUE_STRING;
      const std::string text = feature->GetFieldAsString(i);
      if (!numeric && !text.empty()) found.push_back({number, field.GetNameRef(), text});
    }
  }
  return found;
}

}  // namespace talus
