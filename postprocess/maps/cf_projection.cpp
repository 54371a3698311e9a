// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/cf_projection.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "common/gis/crs.hpp"

namespace talus::postprocess {
namespace {

using Json = nlohmann::json;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// A value in degrees or metres: PROJJSON names units other than these with their factor to radians or metres.
double value_of(const Json& number) {
  if (number.is_number()) return number.get<double>();
  const double value = number.at("value").get<double>();
  const Json unit = number.value("unit", Json());
  if (!unit.is_object()) return value;
  const double factor = unit.at("conversion_factor").get<double>();
  return value * factor * (unit.at("type") == "AngularUnit" ? 180 / std::numbers::pi : 1);
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

void add_figure_of_the_earth(CfProjection& projection, const Json& ellipsoid, const Json& meridian) {
  if (ellipsoid.contains("radius")) {
    add(projection, "semi_major_axis", value_of(ellipsoid["radius"]));
    add(projection, "inverse_flattening", 0);
  } else {
    const double a = value_of(ellipsoid.at("semi_major_axis"));
    add(projection, "semi_major_axis", a);
    add(projection, "inverse_flattening",
        ellipsoid.contains("inverse_flattening") ? value_of(ellipsoid["inverse_flattening"])
                                                 : a / (a - value_of(ellipsoid.at("semi_minor_axis"))));
  }
  add(projection, "longitude_of_prime_meridian", meridian.is_object() ? value_of(meridian.at("longitude")) : 0.0);
}

/// A polar projection given by its standard parallel lies at the pole of that side.
void add_pole(CfProjection& projection) {
  if (projection.grid_mapping_name != "polar_stereographic") return;
  for (const auto& [name, values] : std::vector(projection.numbers)) {
    if (name == "standard_parallel") add(projection, "latitude_of_projection_origin", values[0] < 0 ? -90 : 90);
  }
}

/// CF's oblique Mercator has no angle of its own between its axes and its central line.
bool lies_along_its_line(const Json& parameters) {
  double azimuth = 0, angle = 0;
  for (const Json& parameter : parameters) {
    const std::string name = lower(parameter.at("name"));
    if (name.starts_with("azimuth")) azimuth = value_of(parameter);
    if (name.starts_with("angle from rectified")) angle = value_of(parameter);
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

/// The CRS without the transformation that some files bind to it.
Json unbound(const Json& crs) { return crs.value("type", "") == "BoundCRS" ? crs.at("source_crs") : crs; }

CfProjection projection_of(const Json& crs) {
  CfProjection projection;
  if (crs.value("type", "") != "ProjectedCRS") return projection;
  const Json &conversion = crs.at("conversion"), &base = crs.at("base_crs");
  const auto method = methods.find(lower(conversion.at("method").at("name")));
  if (method == methods.end()) return projection;
  projection.grid_mapping_name = method->second.cf;
  const Json parameters = conversion.value("parameters", Json::array());
  for (const Json& parameter : parameters) {
    const std::string key = lower(parameter.at("name"));
    const auto own = method->second.own.find(key);
    const auto shared = common_names.find(key);
    if (own != method->second.own.end()) {
      if (!own->second.empty()) add(projection, own->second, value_of(parameter));
    } else if (shared != common_names.end()) {
      add(projection, shared->second, value_of(parameter));
    }
  }
  if (projection.grid_mapping_name == "oblique_mercator" && !lies_along_its_line(parameters)) return {};
  add_pole(projection);
  const Json& datum = base.contains("datum") ? base.at("datum") : base.at("datum_ensemble");
  const Json meridian = datum.value("prime_meridian", Json());
  add_figure_of_the_earth(projection, datum.at("ellipsoid"), meridian);
  std::string datum_name = datum.at("name");
  if (datum_name.ends_with(" ensemble")) datum_name.resize(datum_name.size() - 9);
  projection.words = {{"projected_crs_name", crs.at("name")},
                      {"geographic_crs_name", base.at("name")},
                      {"horizontal_datum_name", datum_word(datum_name)},
                      {"reference_ellipsoid_name", datum.at("ellipsoid").at("name")},
                      {"prime_meridian_name", meridian.is_object() ? meridian.at("name") : Json("Greenwich")}};
  return projection;
}

}  // namespace

CfProjection cf_projection(const std::string& wkt) {
  const Json crs = Json::parse(crs_projjson(wkt), nullptr, false);
  return crs.is_object() ? projection_of(unbound(crs)) : CfProjection();
}

}  // namespace talus::postprocess
