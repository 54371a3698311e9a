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
  Names own;  // where CF calls a parameter otherwise for this projection
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
    if (own != method->second.own.end())
      add(projection, own->second, values[0]);
    else if (shared != common_names.end())
      add(projection, shared->second, values[0]);
  }
  add_figure_of_the_earth(projection, wkt2);
  return projection;
}

}  // namespace talus::postprocess
