// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/bed.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

void BedZone::describe(recipe::Visitor& v, const std::string& place) {
  v.path("polygons", polygons, "vector file of the ground where the row holds, such as forest; none: everywhere");
  v.optional_number("from_m", from, recipe::any, "elevation of the bed from which on the row holds");
  v.optional_number("to_m", to, recipe::any, "elevation up to which it holds");
  v.needs(!from || !to || *from < *to,
          fault(fmt::format("{}: from_m = {:g} is not below to_m = {:g}", place, from.value_or(0), to.value_or(0)),
                "no ground lies between", "Give the lower elevation first"));
  v.optional_number("friction_coefficient", friction_coefficient, recipe::not_negative,
                    "mu there; [solve.base] friction_angle_deg becomes its arctangent");
  v.optional_number("added_coefficient", added_coefficient, recipe::any,
                    "what mu is more there than by the rows above, such as in forest");
  v.needs(!friction_coefficient || !added_coefficient,
          fault(place + ": friction_coefficient and added_coefficient are both given", "a row sets mu or adds to it",
                "Give one"));
  v.optional_number("turbulence_m_s2", turbulence, recipe::positive, "xi there, [solve.base] turbulence_m_s2");
  v.needs(friction_coefficient || added_coefficient || turbulence,
          fault(place + ": it gives no number", "the row would have no effect",
                "Give friction_coefficient, added_coefficient or turbulence_m_s2"));
}

void BedRaster::describe(recipe::Visitor& v, const std::string& place) {
  v.one_of("number", number, {bed_numbers.begin(), bed_numbers.end()},
           "the key of [solve.base] that it takes the place of");
  v.path("file", file, "raster of it; no data: the number in [solve.base]");
  v.needs(!file.empty(), fault(place + ": file is not given", "there is nothing to read", "Name a raster"));
}

void BedRasters::describe(recipe::Visitor& v) {
  recipe::list(v, "raster", rasters, "a number of [solve.base] from place to place; may be repeated",
               [&](BedRaster& one, std::size_t item) {
                 one.describe(v, fmt::format("bed.raster {}", item + 1));
                 const auto same = [&](const BedRaster& other) { return other.number == one.number; };
                 v.needs(std::ranges::count_if(rasters, same) < 2,
                         fault(fmt::format("bed.raster {}: number = \"{}\" is given twice", item + 1, one.name()),
                               "one raster would hide the other", "Leave one out"));
               });
  v.path("polygons", polygons,
         "vector file whose polygons have such numbers as attributes of the same names; laid over the rasters");
  recipe::list(v, "zone", zones,
               "a row of a table of Voellmy's numbers, laid over the rasters and the rows above; may be repeated",
               [&](BedZone& zone, std::size_t item) { zone.describe(v, fmt::format("bed.zone {}", item + 1)); });
}

}  // namespace talus::preprocess
