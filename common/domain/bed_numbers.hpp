// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of the bed's friction that may change from place to place: what talus-preprocess reads as rasters and
// talus-solve takes in place of [solve.base].
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace talus {

/// Keys of those numbers, in [preprocess.bed] and [solve.base] alike.
inline constexpr std::array<std::string_view, 14> bed_numbers{
    "friction_angle_deg", "peak_coefficient",    "steady_coefficient",   "characteristic_speed_m_s",
    "turbulence_m_s2",    "bartelt_cohesion_Pa", "friction_coefficient", "minimum_shear_Pa",
    "stop_angle_deg",     "steepest_angle_deg",  "start_angle_deg",      "layer_length_m",
    "cohesion_Pa",        "pore_pressure_ratio"};
/// The depth of the water table below the surface at the start, table_depth_m of [solve.water].
inline constexpr std::string_view water_table = "water_table_depth_m";

/// A number in another form: mu of an angle, mu = tan(angle) (T13), or NGI's k of Voellmy's xi, k = g / xi.
struct BedForm {
  std::string_view key, of;  ///< `of`: the number that the solver makes of it
};
inline constexpr std::array<BedForm, 5> bed_forms{{{"friction_coefficient", "friction_angle_deg"},
                                                   {"stop_coefficient", "stop_angle_deg"},
                                                   {"steepest_coefficient", "steepest_angle_deg"},
                                                   {"start_coefficient", "start_angle_deg"},
                                                   {"drag_coefficient", "turbulence_m_s2"}}};

/// All that rasters and polygons may give: the numbers, those forms that are none themselves, and the water table.
inline constexpr auto bed_names = [] {
  std::array<std::string_view, bed_numbers.size() + bed_forms.size()> names{};
  std::size_t n = 0;
  for (const std::string_view number : bed_numbers) names[n++] = number;
  for (std::size_t form = 1; form < bed_forms.size(); ++form) names[n++] = bed_forms[form].key;  // the first is one
  names[n] = water_table;
  return names;
}();

/// The form of this key; null where it is none.
constexpr const BedForm* bed_form(std::string_view key) {
  for (const BedForm& form : bed_forms)
    if (form.key == key) return &form;
  return nullptr;
}

}  // namespace talus
