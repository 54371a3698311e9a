// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/nc_file.hpp"

#include <cctype>
#include <cstdint>
#include <ctime>
#include <map>
#include <numbers>
#include <numeric>

#include <fmt/chrono.h>
#include <nlohmann/json.hpp>

#include "common/gis/crs.hpp"
#include "common/stage/checksum.hpp"
#include "postprocess/maps/maps.hpp"

namespace talus::postprocess {
namespace {

std::string digest_of(std::span<const double> values) {
  Sha256 sum;
  const auto bytes = std::as_bytes(values);
  sum.add({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  return sum.digest();
}

std::string name_of(const NcRecord::Place& place) {
  if (!place.variable.empty()) return place.variable;
  return place.group.empty() ? "the file" : place.group;
}

/// A file in memory, opened to be read.
struct Opened {
  explicit Opened(const std::string& bytes) {
    // The library does not write to what it opens for reading.
    if (nc_open_mem("written", NC_NOWRITE, bytes.size(), const_cast<char*>(bytes.data()), &root) != NC_NOERR) root = -1;
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  ~Opened() {
    if (root >= 0) nc_close(root);
  }
  /// The id of a place's group; -1 where there is none.
  int group(const NcRecord::Place& place) const {
    int id = root;
    return place.group.empty() || nc_inq_grp_ncid(root, place.group.c_str(), &id) == NC_NOERR ? id : -1;
  }
  /// The id of a place's variable; one that no variable has where there is none.
  int variable(const NcRecord::Place& place) const {
    int id = NC_GLOBAL;
    if (place.variable.empty()) return id;
    return nc_inq_varid(group(place), place.variable.c_str(), &id) == NC_NOERR ? id : NC_MAX_VARS;
  }

  int root = -1;
};

bool has_attribute(int group, int variable, const std::string& name, std::size_t length) {
  std::size_t found = 0;
  return nc_inq_attlen(group, variable, name.c_str(), &found) == NC_NOERR && found == length;
}

using Json = nlohmann::json;

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
  for (const auto& [name, values] : std::vector(projection.numbers))
    if (name == "standard_parallel") add(projection, "latitude_of_projection_origin", values[0] < 0 ? -90 : 90);
}

/// CF's oblique Mercator has no angle of its own between its axes and its central line.
bool lies_along_its_line(const Json& parameters) {
  double azimuth = 0, angle = 0;
  for (const Json& parameter : parameters) {
    const std::string name = lower_case(parameter.at("name"));
    if (name.starts_with("azimuth")) azimuth = value_of(parameter);
    if (name.starts_with("angle from rectified")) angle = value_of(parameter);
  }
  return azimuth == angle;
}

/// CF's spelling of a datum: everything but letters and digits is one underscore.
std::string datum_word(const std::string& name) {
  std::string word;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      word += c;
    else if (!word.empty() && word.back() != '_')
      word += '_';
  while (!word.empty() && word.back() == '_') word.pop_back();
  return word;
}

/// The CRS without the transformation that some files bind to it.
Json unbound(const Json& crs) { return crs.value("type", "") == "BoundCRS" ? crs.at("source_crs") : crs; }

CfProjection projection_of(const Json& crs) {
  CfProjection projection;
  if (crs.value("type", "") != "ProjectedCRS") return projection;
  const Json &conversion = crs.at("conversion"), &base = crs.at("base_crs");
  const auto method = methods.find(lower_case(conversion.at("method").at("name")));
  if (method == methods.end()) return projection;
  projection.grid_mapping_name = method->second.cf;
  const Json parameters = conversion.value("parameters", Json::array());
  for (const Json& parameter : parameters) {
    const std::string key = lower_case(parameter.at("name"));
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

void fill_axis(Nc& nc, const NcAxis& axis, int count, double start, double cell) {
  std::vector<double> centres, bounds;
  for (int i = 0; i < count; ++i) {
    centres.push_back(start + (i + 0.5) * cell);
    bounds.insert(bounds.end(), {start + i * cell, start + (i + 1) * cell});
  }
  nc.put(axis.variable, centres);
  nc.put(axis.bounds, bounds);
}

}  // namespace

void NcRecord::values(const Place& place, const std::vector<std::size_t>& start, const std::vector<std::size_t>& count,
                      std::span<const double> values) {
  const auto holds = [start, count, digest = digest_of(values)](int group, int variable) {
    std::vector<double> found(std::accumulate(count.begin(), count.end(), std::size_t{1}, std::multiplies<>()));
    return nc_get_vara_double(group, variable, start.data(), count.data(), found.data()) == NC_NOERR &&
           digest_of(found) == digest;
  };
  checks_.push_back({place, "the values", holds});
}

void NcRecord::texts(const Place& place, const std::vector<std::string>& texts) {
  const auto holds = [texts](int group, int variable) {
    std::vector<char*> found(texts.size(), nullptr);
    if (nc_get_var_string(group, variable, found.data()) != NC_NOERR) return false;
    const bool same = std::equal(texts.begin(), texts.end(), found.begin(),
                                 [](const std::string& text, const char* other) { return other && text == other; });
    nc_free_string(found.size(), found.data());
    return same;
  };
  checks_.push_back({place, "the texts", holds});
}

void NcRecord::text(const Place& place, const std::string& name, const std::string& value) {
  const auto holds = [name, value](int group, int variable) {
    if (!has_attribute(group, variable, name, value.size())) return false;
    std::string found(value.size(), '\0');
    return nc_get_att_text(group, variable, name.c_str(), found.data()) == NC_NOERR && found == value;
  };
  checks_.push_back({place, name, holds});
}

void NcRecord::numbers(const Place& place, const std::string& name, const std::vector<double>& values) {
  const auto holds = [name, values](int group, int variable) {
    if (!has_attribute(group, variable, name, values.size())) return false;
    std::vector<double> found(values.size());
    return nc_get_att_double(group, variable, name.c_str(), found.data()) == NC_NOERR &&
           digest_of(found) == digest_of(values);
  };
  checks_.push_back({place, name, holds});
}

std::string NcRecord::difference(const std::string& bytes) const {
  const Opened file(bytes);
  if (file.root < 0) return "it does not open";
  for (const auto& [place, what, holds] : checks_)
    if (!holds(file.group(place), file.variable(place))) return what + " of " + name_of(place);
  return {};
}

CfProjection cf_projection(const std::string& wkt) {
  const Json crs = Json::parse(crs_projjson(wkt), nullptr, false);
  return crs.is_object() ? projection_of(unbound(crs)) : CfProjection();
}

NcAxes define_axes(Nc& nc, const MapGrid& grid) {
  NcAxes axes;
  axes.y.dimension = nc.dimension("y", static_cast<std::size_t>(grid.rows));
  axes.x.dimension = nc.dimension("x", static_cast<std::size_t>(grid.columns));
  const int sides = nc.dimension("bnds", 2);
  for (const bool is_x : {true, false}) {
    auto& [dimension, variable, bounds] = is_x ? axes.x : axes.y;
    variable = nc.variable(is_x ? "x" : "y", NC_DOUBLE, {dimension});
    bounds = nc.variable(is_x ? "x_bnds" : "y_bnds", NC_DOUBLE, {dimension, sides});
    nc.text(variable, "standard_name", is_x ? "projection_x_coordinate" : "projection_y_coordinate");
    nc.text(variable, "long_name", is_x ? "easting of the cell centre" : "northing of the cell centre");
    nc.text(variable, "units", "m");
    nc.text(variable, "axis", is_x ? "X" : "Y");
    nc.text(variable, "bounds", is_x ? "x_bnds" : "y_bnds");
  }
  return axes;
}

void define_crs(Nc& nc, const MapGrid& grid) {
  const int id = nc.variable("crs", NC_INT, {});
  const auto projection = cf_projection(grid.crs_wkt);
  nc.text(id, "long_name", "coordinate reference system");
  if (!projection.grid_mapping_name.empty()) nc.text(id, "grid_mapping_name", projection.grid_mapping_name);
  for (const auto& [name, words] : projection.words) nc.text(id, name.c_str(), words);
  for (const auto& [name, values] : projection.numbers) nc.numbers(id, name.c_str(), values);
  nc.text(id, "crs_wkt", grid.crs_wkt);
  nc.text(id, "spatial_ref", grid.crs_wkt);  // GDAL's name for it
  nc.text(id, "GeoTransform", fmt::format("{} {} 0 {} 0 {}", grid.west, grid.cell, grid.north(), -grid.cell));
}

int define_time(Nc& nc, int dimension, const std::string& start) {
  const int id = nc.variable("time", NC_DOUBLE, {dimension});
  nc.text(id, "standard_name", "time");
  nc.text(id, "long_name", "time since the start of the failure");
  nc.text(id, "units", "seconds since " + (start.empty() ? std::string(nominal_start) : start));
  nc.text(id, "calendar", "standard");
  nc.text(id, "axis", "T");
  return id;
}

void fill_axes(Nc& nc, const NcAxes& axes, const MapGrid& grid) {
  fill_axis(nc, axes.x, grid.columns, grid.west, grid.cell);
  fill_axis(nc, axes.y, grid.rows, grid.south, grid.cell);
}

void describe_file(Nc& nc, const std::string& title, const std::string& institution, const std::string& source,
                   const std::string& command_line) {
  nc.text(NC_GLOBAL, "Conventions", "CF-1.8");
  nc.text(NC_GLOBAL, "title", title);
  nc.text(NC_GLOBAL, "institution", institution.empty() ? "not stated" : institution);
  nc.text(NC_GLOBAL, "source", source);
  nc.text(NC_GLOBAL, "history",
          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}: {}", fmt::gmtime(std::time(nullptr)), command_line));
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string nc_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

}  // namespace talus::postprocess
