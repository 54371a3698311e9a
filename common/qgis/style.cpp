// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/qgis/style.hpp"

#include <fmt/format.h>

#include "common/qgis/renderer.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double see_through = 0.85;  // the hillshade below stays readable

XmlDocument style_document() {
  return {"qgis", {{"version", "3.22.0"}, {"styleCategories", "Symbology"}, {"hasScaleBasedVisibilityFlag", "0"}}};
}

fs::path write_beside(const fs::path& raster_file, const XmlDocument& document) {
  fs::path file = raster_file;
  file.replace_extension(".qml");
  write_text(file, document.text(qgis_doctype));
  return file;
}

}  // namespace

RasterStyle class_style(const std::vector<double>& limits, const std::string& unit, Ramp ramp) {
  RasterStyle style{{}, -infinity, limits.empty() ? infinity : limits.front(), see_through};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double upper = i + 1 < limits.size() ? limits[i + 1] : infinity;
    style.classes.push_back({upper, class_colour(i, limits.size(), ramp), class_label(i, limits) + " " + unit});
  }
  return style;
}

RasterStyle time_style(const std::vector<double>& limits, const std::string& unit) {
  RasterStyle style{{}, 0, 0, see_through};
  const std::size_t count = limits.size() + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Colour colour = class_colour(count - 1 - i, count, Ramp::sea);
    std::string label = i == 0 && !limits.empty() ? fmt::format("< {:g}", limits[0])
                        : limits.empty()          ? "all"
                                                  : class_label(i - 1, limits);
    label += " " + unit;
    style.classes.push_back({i < limits.size() ? limits[i] : infinity, colour, label});
  }
  return style;
}

RasterStyle difference_style(const std::vector<double>& limits, const std::string& unit) {
  const std::size_t count = limits.size();
  RasterStyle style{{}, count == 0 ? -infinity : -limits.front(), count == 0 ? infinity : limits.front(), see_through};
  for (std::size_t i = count; i-- > 0;) {
    const auto label = i + 1 == count ? fmt::format("< \u2212{:g} {}", limits[i], unit)
                                      : fmt::format("\u2212{:g} \u2013 \u2212{:g} {}", limits[i + 1], limits[i], unit);
    style.classes.push_back({-limits[i], difference_colour(false, i, count), label});
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double upper = i + 1 < count ? limits[i + 1] : infinity;
    const auto label = i + 1 == count ? fmt::format("> +{:g} {}", limits[i], unit)
                                      : fmt::format("+{:g} \u2013 +{:g} {}", limits[i], limits[i + 1], unit);
    style.classes.push_back({upper, difference_colour(true, i, count), label});
  }
  return style;
}

fs::path write_qgis_style(const fs::path& raster_file, const RasterStyle& style) {
  const XmlDocument document = style_document();
  add_class_renderer(document.root(), style);
  return write_beside(raster_file, document);
}

fs::path write_qgis_hillshade_style(const fs::path& raster_file) {
  const XmlDocument document = style_document();
  add_hillshade_renderer(document.root());
  return write_beside(raster_file, document);
}

}  // namespace talus
