// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/bed.hpp"

#include <fmt/format.h>

#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

void BedZone::describe(recipe::Visitor& v, const std::string& place, const std::optional<double>& chosen) {
  v.path("polygons", polygons, "vector file of the ground where the row holds, such as forest; none: everywhere");
  v.optional_number("from_m", from, recipe::any, "elevation of the bed from which on the row holds");
  v.optional_number("to_m", to, recipe::any, "elevation up to which it holds");
  v.needs(!from || !to || *from < *to,
          fault(fmt::format("{}: from_m = {:g} is not below to_m = {:g}", place, from.value_or(0), to.value_or(0)),
                "no ground lies between", "Give the lower elevation first"));
  v.optional_number("smallest_volume_m3", smallest_volume, recipe::not_negative,
                    "released volume from which on the row holds");
  v.optional_number("largest_volume_m3", largest_volume, recipe::positive, "released volume up to which it holds");
  v.needs(!smallest_volume || !largest_volume || *smallest_volume < *largest_volume,
          fault(fmt::format("{}: smallest_volume_m3 = {:g} is not below largest_volume_m3 = {:g}", place,
                            smallest_volume.value_or(0), largest_volume.value_or(0)),
                "no volume lies between", "Give the smaller volume first"));
  v.optional_number("return_period_years", return_period_years, recipe::positive,
                    "return period for which the row holds; none: for any");
  v.needs(!return_period_years || chosen,
          fault(fmt::format("{}: return_period_years = {:g}, but [preprocess.bed] names no return period", place,
                            return_period_years.value_or(0)),
                "it is not known whether the row holds", "Give [preprocess.bed] return_period_years"));
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

bool BedZone::holds_for(double volume, const std::optional<double>& return_period) const {
  return (!return_period_years || return_period_years == return_period) &&
         (!smallest_volume || volume >= *smallest_volume) && (!largest_volume || volume < *largest_volume);
}

void BedRasters::describe(recipe::Visitor& v) {
  for (auto& [name, file] : files)
    v.path(name, file, "raster that takes the place of [solve.base] " + name + "; no data: that number");
  v.path("polygons", polygons,
         "vector file whose polygons have such numbers as attributes of the same names; laid over the rasters");
  v.optional_number("return_period_years", return_period_years, recipe::positive,
                    "return period whose rows of [[preprocess.bed.zone]] hold");
  recipe::list(v, "zone", zones,
               "a row of a table of Voellmy's numbers, laid over the rasters and the rows above; may be repeated",
               [&](BedZone& zone, std::size_t item) {
                 zone.describe(v, fmt::format("bed.zone {}", item + 1), return_period_years);
               });
}

}  // namespace talus::preprocess
