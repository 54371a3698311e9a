// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed's friction from place to place: rasters of its numbers, and zones.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/domain/bed_numbers.hpp"
#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

/// One [[preprocess.bed.zone]]: Voellmy's numbers for some heights or some ground, a row of the tables by which
/// guidelines give them. What is not given sets no bound.
struct BedZone {
  std::filesystem::path polygons{};
  std::optional<double> from{}, to{};            ///< elevations [m]
  std::optional<double> friction_coefficient{};  ///< mu [-]
  std::optional<double> added_coefficient{};     ///< to the mu of the rows above [-]
  std::optional<double> turbulence{};            ///< xi [m/s2]
  std::optional<double> drag_coefficient{};      ///< k = g / xi [-]

  /// Declares the keys with defaults, help and what they need; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place) {
    v.path("polygons", polygons, "vector file of the ground where the row holds, such as forest; none: everywhere");
    v.optional_number("from_m", from, recipe::any, "elevation of the bed from which on the row holds");
    v.optional_number("to_m", to, recipe::any, "elevation up to which it holds");
    need(v, !from || !to || *from < *to,
         fmt::format("{}: from_m = {:g} is not below to_m = {:g}", place, from.value_or(0), to.value_or(0)),
         "no ground lies between", "Give the lower elevation first");
    v.optional_number("friction_coefficient", friction_coefficient, recipe::not_negative,
                      "mu there; [solve.base] friction_angle_deg becomes its arctangent");
    v.optional_number("added_coefficient", added_coefficient, recipe::any,
                      "what mu is more there than by the rows above, such as in forest");
    need(v, !friction_coefficient || !added_coefficient,
         place + ": friction_coefficient and added_coefficient are both given", "a row sets mu or adds to it",
         "Give one");
    v.optional_number("turbulence_m_s2", turbulence, recipe::positive, "xi there, [solve.base] turbulence_m_s2");
    v.optional_number("drag_coefficient", drag_coefficient, recipe::positive, "k = g / xi there, in place of xi");
    need(v, !turbulence || !drag_coefficient, place + ": turbulence_m_s2 and drag_coefficient are both given",
         "they are one quantity", "Give one");
    need(v, friction_coefficient || added_coefficient || turbulence || drag_coefficient, place + ": it gives no number",
         "the row would have no effect",
         "Give friction_coefficient, added_coefficient, turbulence_m_s2 or drag_coefficient");
  }
};

/// One [[preprocess.bed.raster]].
struct BedRaster {
  int number = 0;  ///< of bed_names
  std::filesystem::path file{};

  /// Key of the number in [solve.base].
  std::string_view name() const { return bed_names.at(static_cast<std::size_t>(number)); }
  /// Declares the keys with defaults, help and what they need; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place) {
    v.one_of("number", number, {bed_names.begin(), bed_names.end()},
             "the key of [solve.base] that it takes the place of");
    v.path("file", file, "raster of it; no data: the number in [solve.base]");
    need(v, !file.empty(), place + ": file is not given", "there is nothing to read", "Name a raster");
  }
};

/// The keys of [preprocess.bed]: rasters under the names of the numbers in [solve.base] that they take the place of,
/// polygons with the same numbers as attributes, and zones; each is laid over those before.
struct BedRasters {
  std::vector<BedRaster> rasters;
  std::filesystem::path polygons;  ///< with the numbers as attributes
  std::vector<BedZone> zones;

  void describe(recipe::Visitor& v) {
    recipe::list(
        v, "raster", rasters, "a number of [solve.base] from place to place; may be repeated",
        [&](BedRaster& one, std::size_t item) {
          one.describe(v, fmt::format("bed.raster {}", item + 1));
          const auto same = [&](const BedRaster& other) { return other.number == one.number; };
          need(v, std::ranges::count_if(rasters, same) < 2,
               fmt::format("bed.raster {}: number = \"{}\" is given twice", item + 1, one.name()),
               "one raster would hide the other", "Leave one out");
          const BedForm* const form = bed_form(one.name());
          const auto other_form = [&](const BedRaster& other) { return form && other.name() == form->of; };
          need(v, std::ranges::none_of(rasters, other_form),
               fmt::format("bed.raster {}: number = \"{}\" beside \"{}\"", item + 1, one.name(), form ? form->of : ""),
               "they are one quantity in two forms", "Leave one out");
        });
    v.path("polygons", polygons,
           "vector file whose polygons have such numbers as attributes of the same names; laid over the rasters");
    recipe::list(v, "zone", zones,
                 "a row of a table of Voellmy's numbers, laid over the rasters and the rows above; may be repeated",
                 [&](BedZone& zone, std::size_t item) { zone.describe(v, fmt::format("bed.zone {}", item + 1)); });
    const auto with = [&](std::optional<double> BedZone::*number) {
      return std::ranges::any_of(zones, [&](const BedZone& zone) { return (zone.*number).has_value(); });
    };
    need(v, !with(&BedZone::turbulence) || !with(&BedZone::drag_coefficient),
         "bed.zone: some rows give turbulence_m_s2, others drag_coefficient", "they are one quantity",
         "Give one of them in all rows");
  }
};

}  // namespace talus::preprocess
