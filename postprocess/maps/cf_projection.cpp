// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/cf_projection.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <optional>

namespace talus::postprocess {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The text after KEYWORD[" up to the next quote, from `start` on; moves `start` behind it.
std::optional<std::string> next_name(const std::string& wkt, const std::string& keyword, std::size_t& start) {
  const auto mark = keyword + "[\"";
  const auto found = wkt.find(mark, start);
  if (found == std::string::npos) return std::nullopt;
  const auto begin = found + mark.size(), end = wkt.find('"', begin);
  if (end == std::string::npos) return std::nullopt;
  start = end + 1;
  return wkt.substr(begin, end - begin);
}

/// Numbers that follow a name: ,6378137,298.257...
std::vector<double> numbers_at(const std::string& wkt, std::size_t start) {
  std::vector<double> values;
  while (start < wkt.size() && wkt[start] == ',') {
    char* end = nullptr;
    const double value = std::strtod(wkt.c_str() + start + 1, &end);
    if (end == wkt.c_str() + start + 1) break;
    values.push_back(value);
    start = static_cast<std::size_t>(end - wkt.c_str());
  }
  return values;
}

using Names = std::map<std::string, std::string>;  // EPSG's parameter name, lower case -> CF's

const Names common_names = {{"latitude of natural origin", "latitude_of_projection_origin"},
                            {"latitude of false origin", "latitude_of_projection_origin"},
                            {"longitude of natural origin", "longitude_of_central_meridian"},
                            {"longitude of false origin", "longitude_of_central_meridian"},
                            {"latitude of 1st standard parallel", "standard_parallel"},
                            {"latitude of 2nd standard parallel", "standard_parallel"},
                            {"false easting", "false_easting"},
                            {"false northing", "false_northing"},
                            {"easting at false origin", "false_easting"},
                            {"northing at false origin", "false_northing"}};

struct Method {
  const char* cf;
  Names own;  // where CF calls a parameter otherwise for this projection; "" where it has none
};

const std::map<std::string, Method> methods = {
    {"transverse mercator",
     {"transverse_mercator", {{"scale factor at natural origin", "scale_factor_at_central_meridian"}}}},
    {"lambert conic conformal (2sp)", {"lambert_conformal_conic", {}}},
    {"albers equal area", {"albers_conical_equal_area", {}}},
    {"lambert azimuthal equal area",
     {"lambert_azimuthal_equal_area", {{"longitude of natural origin", "longitude_of_projection_origin"}}}},
    {"polar stereographic (variant a)",
     {"polar_stereographic",
      {{"longitude of natural origin", "straight_vertical_longitude_from_pole"},
       {"scale factor at natural origin", "scale_factor_at_projection_origin"}}}},
    {"oblique stereographic",
     {"stereographic",
      {{"longitude of natural origin", "longitude_of_projection_origin"},
       {"scale factor at natural origin", "scale_factor_at_projection_origin"}}}},
    {"polar stereographic (variant b)",
     {"polar_stereographic",
      {{"latitude of standard parallel", "standard_parallel"},
       {"longitude of origin", "straight_vertical_longitude_from_pole"}}}},
    {"mercator (variant a)",
     {"mercator",
      {{"longitude of natural origin", "longitude_of_projection_origin"},
       {"latitude of natural origin", ""},
       {"scale factor at natural origin", "scale_factor_at_projection_origin"}}}},
    {"hotine oblique mercator (variant b)",
     {"oblique_mercator",
      {{"latitude of projection centre", "latitude_of_projection_origin"},
       {"longitude of projection centre", "longitude_of_projection_origin"},
       {"azimuth at projection centre", "azimuth_of_central_line"},
       {"azimuth of initial line", "azimuth_of_central_line"},
       {"scale factor at projection centre", "scale_factor_at_projection_origin"},
       {"scale factor on initial line", "scale_factor_at_projection_origin"},
       {"easting at projection centre", "false_easting"},
       {"northing at projection centre", "false_northing"}}}},
};

void add(CfProjection& projection, const std::string& name, double value) {
  const auto same = [&](const auto& item) { return item.first == name; };
  const auto found = std::find_if(projection.numbers.begin(), projection.numbers.end(), same);
  if (found == projection.numbers.end())
    projection.numbers.push_back({name, {value}});
  else
    found->second.push_back(value);  // the second standard parallel
}

void add_figure_of_the_earth(CfProjection& projection, const std::string& wkt) {
  std::size_t place = 0;
  if (next_name(wkt, "ELLIPSOID", place)) {
    const auto axes = numbers_at(wkt, place);
    if (axes.size() >= 2) {
      add(projection, "semi_major_axis", axes[0]);
      add(projection, "inverse_flattening", axes[1]);
    }
  }
  place = 0;
  const bool other = next_name(wkt, "PRIMEM", place).has_value();
  const auto meridian = other ? numbers_at(wkt, place) : std::vector<double>{};
  add(projection, "longitude_of_prime_meridian", meridian.empty() ? 0.0 : meridian[0]);
}

/// A polar projection given by its standard parallel lies at the pole of that side.
void add_pole(CfProjection& projection) {
  if (projection.grid_mapping_name != "polar_stereographic") return;
  for (const auto& [name, values] : std::vector(projection.numbers)) {
    if (name == "standard_parallel") add(projection, "latitude_of_projection_origin", values[0] < 0 ? -90 : 90);
  }
}

/// CF's oblique Mercator has no angle of its own between its axes and its central line.
bool lies_along_its_line(const std::string& wkt) {
  std::size_t place = 0;
  double azimuth = 0, angle = 0;
  while (const auto parameter = next_name(wkt, "PARAMETER", place)) {
    const auto values = numbers_at(wkt, place);
    if (values.empty()) continue;
    if (lower(*parameter).starts_with("azimuth")) azimuth = values[0];
    if (lower(*parameter).starts_with("angle from rectified")) angle = values[0];
  }
  return azimuth == angle;
}

/// CF's spelling of a datum: everything but letters and digits is one underscore.
std::string datum_word(const std::string& name) {
  std::string word;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      word += c;
    else if (!word.empty() && word.back() != '_')
      word += '_';
  }
  while (!word.empty() && word.back() == '_') word.pop_back();
  return word;
}

void add_names(CfProjection& projection, const std::string& wkt) {
  const auto named = [&](const char* keyword) {
    std::size_t place = 0;
    return next_name(wkt, keyword, place);
  };
  const auto projected = named("PROJCRS"), geographic = named("BASEGEOGCRS"), ellipsoid = named("ELLIPSOID");
  auto datum = named("DATUM");
  if (!datum) datum = named("ENSEMBLE");
  if (!projected || !geographic || !ellipsoid || !datum) return;
  if (datum->ends_with(" ensemble")) datum->resize(datum->size() - 9);
  projection.words = {{"projected_crs_name", *projected},
                      {"geographic_crs_name", *geographic},
                      {"horizontal_datum_name", datum_word(*datum)},
                      {"reference_ellipsoid_name", *ellipsoid},
                      {"prime_meridian_name", named("PRIMEM").value_or("Greenwich")}};
}

}  // namespace

CfProjection cf_projection(const std::string& wkt2) {
  CfProjection projection;
  std::size_t place = 0;
  const auto name = next_name(wkt2, "METHOD", place);
  const auto method = name ? methods.find(lower(*name)) : methods.end();
  // Grads and other units of angle would need converting; no metric national grid with a CF name uses them here.
  if (method == methods.end() || wkt2.find("ANGLEUNIT[\"grad\"") != std::string::npos) return projection;
  projection.grid_mapping_name = method->second.cf;
  while (const auto parameter = next_name(wkt2, "PARAMETER", place)) {
    const auto key = lower(*parameter);
    const auto values = numbers_at(wkt2, place);
    const auto own = method->second.own.find(key);
    const auto shared = common_names.find(key);
    if (values.empty()) continue;
    if (own != method->second.own.end()) {
      if (!own->second.empty()) add(projection, own->second, values[0]);
    } else if (shared != common_names.end()) {
      add(projection, shared->second, values[0]);
    }
  }
  if (projection.grid_mapping_name == "oblique_mercator" && !lies_along_its_line(wkt2)) return {};
  add_pole(projection);
  add_figure_of_the_earth(projection, wkt2);
  add_names(projection, wkt2);
  return projection;
}

}  // namespace talus::postprocess
