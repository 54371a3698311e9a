// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/declared_heights.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/gis/gdal_support.hpp"
#include "common/stage/findings.hpp"

namespace talus {
namespace {

using Json = nlohmann::json;

/// Lower-case letters and digits alone, without the word "ensemble".
std::string key_of(const std::string& name) {
  std::string key;
  for (const char c : name)
    if (const auto u = static_cast<unsigned char>(c); std::isalnum(u) != 0) key += static_cast<char>(std::tolower(u));
  if (const std::string word = "ensemble"; key.ends_with(word)) key.resize(key.size() - word.size());
  return key;
}

std::string text(const Json& in, const char* key) {
  return in.is_object() && in.contains(key) && in.at(key).is_string() ? in.at(key).get<std::string>() : "";
}

/// The CRS itself, where it comes with a transformation to another one.
const Json& unbound(const Json& crs) { return crs.contains("source_crs") ? unbound(crs.at("source_crs")) : crs; }

/// Name of the datum of a CRS, or of the CRS that it is made from; "" where it is not known.
std::string datum_of(const Json& crs) {
  for (const char* key : {"datum", "datum_ensemble"})
    if (crs.contains(key)) {
      const std::string name = text(crs.at(key), "name"), plain = key_of(name);
      const bool unknown = plain.empty() || plain.starts_with("unknown") || plain.starts_with("unnamed") ||
                           plain.starts_with("notspecified");
      return unknown ? "" : name.substr(0, name.find(" ensemble"));
    }
  return crs.contains("base_crs") ? datum_of(unbound(crs.at("base_crs"))) : "";
}

/// The axis that counts up or down; null: none does.
const Json* vertical_axis(const Json& crs) {
  if (!crs.contains("coordinate_system")) return nullptr;
  for (const Json& axis : crs.at("coordinate_system").at("axis"))
    if (const std::string direction = text(axis, "direction"); direction == "up" || direction == "down") return &axis;
  return nullptr;
}

std::string code_of(const Json& crs) {
  const Json id = crs.contains("id") ? crs.at("id") : Json();
  return text(id, "authority") == "EPSG" && id.contains("code") ? id.at("code").dump() : "";
}

/// "EPSG:32633+5773", or a call that writes the CRS of the file.
std::string argument_of(const Json& whole, const Json& horizontal, const Json& vertical,
                        const std::filesystem::path& file) {
  const std::string across = code_of(horizontal), up = code_of(vertical);
  if (&horizontal != &vertical && !across.empty() && !up.empty()) return fmt::format("EPSG:{}+{}", across, up);
  if (!code_of(whole).empty()) return "EPSG:" + code_of(whole);
  return fmt::format("\"$(gdalsrsinfo --single-line -o wkt2 {})\"", file.string());
}

void take_unit(const Json& unit, DeclaredHeights& heights) {
  heights.metres = 1;
  heights.unit = unit.is_string() ? unit.get<std::string>() : text(unit, "name");
  if (unit.is_object() && unit.contains("conversion_factor"))
    heights.metres = unit.at("conversion_factor").get<double>();
  if (heights.unit.empty()) heights.unit = "metre";
}

Json parsed(const OGRSpatialReference* srs) {
  if (srs == nullptr || srs->IsEmpty()) return nullptr;
  const gdal::QuietErrors errors;
  char* json = nullptr;
  const bool known = srs->exportToPROJJSON(&json, nullptr) == OGRERR_NONE && json != nullptr;
  Json all = known ? Json::parse(json, nullptr, false) : Json(nullptr);
  CPLFree(json);
  return all.is_object() ? all : Json(nullptr);
}

}  // namespace

DeclaredHeights gdal::declared_heights(const OGRSpatialReference* srs, const std::filesystem::path& file) {
  DeclaredHeights heights{.file = file};
  const Json json = parsed(srs);
  if (json.is_null()) return heights;
  const Json& whole = unbound(json);
  const bool compound = whole.contains("components") && whole.at("components").size() > 1;
  const Json &horizontal = compound ? unbound(whole.at("components").at(0)) : whole,
             &vertical = compound ? unbound(whole.at("components").at(1)) : whole;
  const Json* axis = vertical_axis(vertical);
  if (axis == nullptr) return heights;
  take_unit(axis->contains("unit") ? axis->at("unit") : Json("metre"), heights);
  heights.downwards = text(*axis, "direction") == "down";
  heights.datum = datum_of(vertical);
  const std::string words = key_of(text(*axis, "name") + text(vertical, "name") + heights.datum);
  if (words.find("ellipsoid") != std::string::npos) {
    const std::string ellipsoid = datum_of(horizontal);
    heights.datum = ellipsoid.empty() ? "" : "ellipsoid of " + ellipsoid;
  }
  heights.crs_arg = argument_of(whole, horizontal, vertical, file);
  return heights;
}

namespace {
constexpr auto datum_fact = "vertical_datum", datum_file = "vertical_datum_of", datum_crs = "vertical_datum_crs";
}

Facts facts_of(const DeclaredHeights& heights) {
  if (heights.datum.empty()) return {};
  return {{datum_fact, heights.datum}, {datum_file, heights.file.string()}, {datum_crs, heights.crs_arg}};
}

DeclaredHeights heights_in(const Facts& facts, const std::filesystem::path& file) {
  const std::string datum = fact(facts, datum_fact);
  if (datum.empty()) return {.file = file};
  return {.file = fact(facts, datum_file), .datum = datum, .crs_arg = fact(facts, datum_crs)};
}

void judge_vertical_datums(const DeclaredHeights& one, const DeclaredHeights& other) {
  if (key_of(one.datum) == key_of(other.datum)) return;
  if (one.datum.empty() || other.datum.empty()) {
    const DeclaredHeights &bare = one.datum.empty() ? one : other, &named = one.datum.empty() ? other : one;
    advise(
        "undeclared-vertical-datum",
        fmt::format("{}: declares no vertical datum, and is taken to have that of {} ({}). Ellipsoid and geoid lie up "
                    "to 100 m apart",
                    bare.file.string(), named.file.string(), named.datum));
    return;
  }
  refuse_unless_accepted(
      "different-vertical-datums",
      {fmt::format("{}: heights above the {}, while those of {} are above the {}", other.file.string(), other.datum,
                   one.file.string(), one.datum),
       "one is subtracted from the other, and such surfaces lie up to 100 m apart",
       fmt::format("Bring it to the other's: gdalwarp -s_srs {} -t_srs {} -r bilinear {} out.tif (with PROJ's grid of "
                   "the geoid: without it heights stay as they are); or mend a wrong declaration: gdal_edit.py -a_srs "
                   "CRS FILE",
                   other.crs_arg, one.crs_arg, other.file.string())});
}

}  // namespace talus
