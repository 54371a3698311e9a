// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/scene/places.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/features.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"

namespace talus::preprocess {
namespace {

/// Attributes are told apart without regard to case, as OGR does.
bool same_field(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char p, unsigned char q) { return std::tolower(p) == std::tolower(q); });
}

bool has_attribute(const PlaceLayer& layer, const std::string& name) {
  return std::ranges::any_of(layer.fields, [&](const std::string& field) { return same_field(field, name); });
}

/// What the file calls a feature; empty where it has no name.
std::string given_name(const PlaceOptions& o, const PlaceFeature& feature) {
  for (const FeatureValue& value : feature.values)
    if (same_field(value.name, o.attribute)) return value.text;
  return "";
}

/// The name of a feature among those that are `taken`; a fault, and empty, where it can have none.
std::string name_of(const PlaceOptions& o, const PlaceFeature& feature, bool named,
                    std::map<std::string, std::string>& taken, std::vector<Fault>& faults) {
  const std::string given = named ? given_name(o, feature) : fmt::format("{}-{}", o.name, feature.number);
  std::string name = plain_name(given);
  const std::string what = fmt::format("{}: {} = \"{}\"", feature.place, o.attribute, given);
  if (name.empty()) {
    faults.push_back({what, "its numbers are recorded under its name: letters, digits, - and _",
                      "Name it, or leave it out by a condition (FILE|subset=CONDITION)"});
    return "";
  }
  const auto [other, is_new] = taken.emplace(name, feature.place);
  if (!is_new) {
    faults.push_back({fmt::format("{}: the name \"{}\" is taken by {}", what, name, other->second),
                      "numbers are recorded under names", "Rename one of them"});
    return "";
  }
  if (name != given) log_info(fmt::format("{}: \"{}\" is called {} here", feature.place, given, name));
  return name;
}

/// Adds the fault of a feature that leaves the ground.
void check_ground(const PlaceFeature& feature, const std::string& name, const Raster& ground,
                  std::vector<Fault>& faults) {
  const MapGrid& map = ground.grid;
  const double east = map.x(map.columns - 1), north = map.y(map.rows - 1);
  const auto inside = [&](const std::array<double, 2>& point) {
    if (!(point[0] >= map.x(0) && point[0] <= east && point[1] >= map.y(0) && point[1] <= north)) return false;
    if (feature.points.size() > 1) return true;         // a line may cross a hole of the ground
    if (map.columns < 2 || map.rows < 2) return false;  // a gauge reads between four cells
    const int column = std::min(static_cast<int>((point[0] - map.x(0)) / map.cell), map.columns - 2);
    const int row = std::min(static_cast<int>((point[1] - map.y(0)) / map.cell), map.rows - 2);
    return !std::isnan(ground.at(column, row) + ground.at(column + 1, row) + ground.at(column, row + 1) +
                       ground.at(column + 1, row + 1));
  };
  const auto beyond = std::ranges::find_if_not(feature.points, inside);
  if (beyond == feature.points.end()) return;
  faults.push_back(
      {fmt::format("{} (\"{}\"): ({:.2f}, {:.2f}) lies outside the domain", feature.place, name, (*beyond)[0],
                   (*beyond)[1]),
       "nothing is computed there",
       fmt::format("Draw it within x {:.2f} to {:.2f}, y {:.2f} to {:.2f}{}, or leave it out by a condition "
                   "(FILE|subset=CONDITION)",
                   map.x(0), east, map.y(0), north, feature.points.size() > 1 ? "" : ", on known ground")});
}

/// Says what became of a file's CRS.
void say_crs(const PlaceOptions& o, const PlaceLayer& layer, const std::string& crs_wkt) {
  if (same_crs(layer.crs_wkt, crs_wkt)) return;
  if (layer.crs_wkt.empty())
    log_info(fmt::format("{}: names no CRS, taken as in {}", o.file.string(), crs_name(crs_wkt)));
  else if (crs_wkt.empty())
    warn("scene-without-crs", fmt::format("{}: is in {}, the scene names no CRS: coordinates are taken as they are",
                                          o.file.string(), crs_name(layer.crs_wkt)));
  else
    log_info(fmt::format("{}: brought from {} to {}", o.file.string(), crs_name(layer.crs_wkt), crs_name(crs_wkt)));
}

void say_what(const PlaceOptions& o, const PlaceLayer& layer, const std::vector<DomainPlace>& places) {
  constexpr std::size_t most_named = 8;
  const auto lines = std::ranges::count_if(places, [](const DomainPlace& one) { return one.is_line(); });
  const auto points = static_cast<std::ptrdiff_t>(places.size()) - lines;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(most_named, places.size()); ++i) names.push_back(places[i].name);
  if (places.size() > most_named) names.emplace_back("...");
  std::vector<std::string> counts;
  if (lines > 0) counts.push_back(fmt::format("{} {}", lines, lines == 1 ? "line" : "lines"));
  if (points > 0) counts.push_back(fmt::format("{} {}", points, points == 1 ? "point" : "points"));
  log_info(fmt::format("place \"{}\": {} of {}, layer \"{}\": {}", o.name, fmt::join(counts, " and "), o.file.string(),
                       layer.name, fmt::join(names, ", ")));
}

std::vector<DomainPlace> read_place(const PlaceOptions& o, const Raster& ground) {
  PlaceLayer layer = read_place_layer(o.file, ground.grid.crs_wkt);
  const bool named = has_attribute(layer, o.attribute);
  if (o.attribute != usual_name_attribute && !named)
    throw DataError({fmt::format("{}: layer \"{}\" has no attribute \"{}\"", o.file.string(), layer.name, o.attribute),
                     layer.fields.empty() ? "it has none" : fmt::format("it has {}", fmt::join(layer.fields, ", ")),
                     "Name the attribute that names its lines or points, or leave the key out"});
  say_crs(o, layer, ground.grid.crs_wkt);
  std::vector<DomainPlace> places;
  std::vector<Fault> faults;
  std::map<std::string, std::string> taken;
  for (PlaceFeature& feature : layer.features) {
    std::string name = name_of(o, feature, named, taken, faults);
    check_ground(feature, name, ground, faults);
    places.push_back({o.name, std::move(name), std::move(feature.points)});
  }
  if (!faults.empty()) throw DataError(std::move(faults));
  say_what(o, layer, places);
  return places;
}

}  // namespace

std::vector<DomainPlace> read_places(const std::vector<PlaceOptions>& options, const Raster& ground) {
  std::vector<DomainPlace> places;
  std::vector<Fault> faults;
  for (const PlaceOptions& o : options) {
    try {
      auto more = read_place(o, ground);
      places.insert(places.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    } catch (const DataError& error) {  // all files at once
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw DataError(std::move(faults));
  return places;
}

}  // namespace talus::preprocess
