// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of the bed's friction that may change from place to place: what talus-preprocess reads as rasters and
// talus-solve takes in place of [solve.base].
#pragma once

#include <array>
#include <string_view>

namespace talus {

/// Keys of those numbers, in [preprocess.bed] and [solve.base] alike.
inline constexpr std::array<std::string_view, 14> bed_numbers{
    "friction_angle_deg", "peak_coefficient",    "steady_coefficient",   "characteristic_speed_m_s",
    "turbulence_m_s2",    "bartelt_cohesion_Pa", "friction_coefficient", "minimum_shear_Pa",
    "stop_angle_deg",     "steepest_angle_deg",  "start_angle_deg",      "layer_length_m",
    "cohesion_Pa",        "pore_pressure_ratio"};

}  // namespace talus
