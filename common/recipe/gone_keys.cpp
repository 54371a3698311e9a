// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/gone_keys.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace talus::recipe {

namespace {

struct GoneKeys {
  std::string_view places;  ///< "table.key" or "table.key=word" of a choice; further keys of the table after blanks
  std::string_view advice;  ///< what to do instead, an imperative without a full stop
};

constexpr std::string_view behind_the_file =
    "Write it behind the name of the file, as QGIS shows it: \"FILE|layername=LAYER|subset=CONDITION\"";

constexpr GoneKeys gone_keys[] = {
    {"budget",
     "Give its keys in [ensemble.budget], with design = \"budget\" in [ensemble]; seed and elevation_error are "
     "keys of [ensemble]"},
    {"ensemble.budget.friction_doubt_deg",
     "Give friction_doubt, a share of the tangent: 0.1 of 20 degrees is 1.9 degrees"},
    {"ensemble.budget.modulus_factor step_factor",
     "Leave it out; the modulus is doubled, steps are halved. Add [[ensemble.budget.run]] with another number of your "
     "own"},
    {"ensemble.keep_all", "Give keep = [\"all\"]"},
    {"ensemble.keep_deposits", "Give keep = [\"deposits\"]"},
    {"ensemble.save_interval_s", "Leave it out; what is finished is saved after the first member and every minute"},
    {"postprocess.animation", "Put \"mp4\" or \"gif\" into outputs of [postprocess]"},
    {"postprocess.avaframe avaframe_format", "Put \"avaframe-tif\" or \"avaframe-asc\" into outputs of [postprocess]"},
    {"postprocess.nodata_zero", "Convert the map where a tool needs that: gdalwarp -dstnodata 0 IN.tif OUT.tif"},
    {"postprocess.report", "Name what is written in outputs: \"report\" and \"report-3d\" are among the default"},
    {"postprocess.three_d",
     "Name what is written in outputs of [postprocess]: \"surface\", \"terrain\", \"points\", \"report-3d\""},
    {"postprocess.intensity.rule",
     "Leave it out; own limits are reached by any of the quantities. guideline = \"swiss-debris-flow\" wants all"},
    {"postprocess.intensity.thickness_speed_m2_s",
     "Take guideline = \"swiss-flood\", which limits that product, or give thickness_m and speed_m_s"},
    {"postprocess.survey.detection", "Leave it out; what is below 1.96 times sigma (95 %) counts as none"},
    {"postprocess.survey.nodata_is_zero",
     "Fill the raster: gdalwarp -dstnodata 0 IN.tif OUT.tif, then gdal_edit.py -unsetnodata OUT.tif"},
    {"postprocess.survey.resamples", "Leave it out; 200 surveys are drawn within their error"},
    {"postprocess.survey.resample_seed", "Leave it out; the same surveys are drawn each time"},
    {"preprocess.before_vertical_unit after_vertical_unit",
     "Declare the unit in the file (gdal_edit.py -units foot FILE), or give vertical_unit for all models"},
    {"preprocess.bed.friction_angle_deg peak_coefficient steady_coefficient characteristic_speed_m_s turbulence_m_s2 "
     "bartelt_cohesion_Pa friction_coefficient minimum_shear_Pa stop_angle_deg steepest_angle_deg start_angle_deg "
     "layer_length_m cohesion_Pa pore_pressure_ratio",
     "Give [[preprocess.bed.raster]] with number and file"},
    {"preprocess.bed.return_period_years", "Give the rows of the volume and return period at hand alone"},
    {"preprocess.bed.roughness_m", "Leave it out; R is one number, 0.05 m, in all sets of com1DFA"},
    {"preprocess.bed.zone.return_period_years smallest_volume_m3 largest_volume_m3",
     "Give the rows of the volume and return period at hand alone"},
    {"preprocess.box.west_m south_m east_m north_m bottom_m top_m",
     "Give extent_m = [west, south, east, north, bottom, top]"},
    {"preprocess.coregistration.steepest_deg",
     "Leave it out; ground steeper than 45 degrees is no part of the fit. Name more in changed"},
    {"preprocess.coregistration.tilt", "Leave it out; a tilt within three times its error is left out"},
    {"preprocess.deposit.bridge_cells longest_gap steepest_rest_deg sure_levels sure_cells",
     "Draw the deposit: polygon in [preprocess.deposit]"},
    {"preprocess.deposit.outside_share",
     "Draw the deposit (polygon), or take accept = [\"change-outside-slide\"] in [postprocess]"},
    {"preprocess.difference.before_sigma_m after_sigma_m", "Give sigma_m, the root of the sum of both models' squares"},
    {"preprocess.difference.confidence", "Leave it out; a change is believed at 95 %"},
    {"preprocess.difference.minimum_level_m", "Give threshold_m in [preprocess.source] and [preprocess.deposit]"},
    {"preprocess.difference.threshold", "Leave it out; a change is believed at 95 %"},
    {"preprocess.erodible.attribute direction",
     "Give the layer as polygons with an attribute \"thickness\", vertical, or as a raster"},
    {"preprocess.erodible.layer where", behind_the_file},
    {"preprocess.erodible.volume_factor grow_m", "Change the thickness or the polygons of the layer"},
    {"preprocess.grid.jitter_seed", "Leave it out; runs with other points take another jitter"},
    {"preprocess.grid.minimum_thickness_m", "Leave it out; fewer points_per_cell make thin columns cheap"},
    {"preprocess.grid.west_m south_m east_m north_m", "Give extent_m = [west, south, east, north]"},
    {"preprocess.laboratory.columns rows", "Give cells = [columns, rows]"},
    {"preprocess.laboratory.slope_x slope_y", "Give slope = [x, y]"},
    {"preprocess.laboratory.west_m south_m ground_m", "Give corner_m = [west, south, ground]"},
    {"preprocess.obstacle.voxel_m",
     "Leave it out; voxels are a quarter of the smaller of spacing_m and layer_height_m"},
    {"preprocess.place.layer where", behind_the_file},
    {"preprocess.release.layer where", behind_the_file},
    {"preprocess.release.volume_factor", "Give volume_m3 of the release, or thickness_factor in [preprocess] for all"},
    {"preprocess.source.layer where", behind_the_file},
    {"preprocess.source.seed_x_m seed_y_m", "Give seed_m = [easting, northing]"},
    {"preprocess.source.sliding_surface.depth_points_hold", "Name the column of depths \"depth\"; z is an elevation"},
    {"preprocess.voids.fill largest_m2", "Give fill_m2, the largest area that is filled, such as 1e5"},
    {"slides.layer where", behind_the_file},
    {"slides.scenario.layer where", behind_the_file},
    {"slides.depth_from",
     "Add [[slides.set]] with key = \"preprocess.source.sliding_surface.depth_m\" and the attribute"},
    {"slides.keep_all", "Give keep = [\"all\"] in [ensemble]"},
    {"slides.save_interval_s", "Leave it out; what is finished is saved after the first slide and every minute"},
    {"slides.failed_share keep thresholds", "Give it in [ensemble], which needs no members beside [slides]"},
    {"slides.thickness_from", "Add [[slides.set]] with key = \"preprocess.release[0].thickness_m\" and the attribute"},
    {"slides.volume_from",
     "Add [[slides.set]] with key = \"preprocess.source.sliding_surface.volume_m3\" and the attribute; with base_dem "
     "\"preprocess.release[0].volume_m3\""},
    {"slides.scenario.depth_m volume_m3",
     "Put \"preprocess.source.sliding_surface.depth_m=...\" or \"...volume_m3=...\" into set"},
    {"slides.scenario.thickness_m", "Put \"preprocess.release[0].thickness_m=...\" into set"},
    {"solve.flip_fraction", "Give transfer_time_s, the time over which velocity finer than the grid decays"},
    {"solve.ground_contact", "Leave it out; mapping = \"terrain-following\" meets steep ground where it is"},
    {"solve.kappa", "Leave it out; it is 0.3, and below 0.25 steps are unstable"},
    {"solve.vdb_frames", "Leave it out; run.h5 holds the points (point_frames)"},
    {"solve.base.drag_offset", "Leave it out; it is 4.13 in all sets of com1DFA"},
    {"solve.base.hysteresis_power", "Leave it out; it is 1 (Edwards et al. 2017)"},
    {"solve.base.karman_constant", "Leave it out; it is 0.43 in all sets of com1DFA"},
    {"solve.base.roughness_m", "Leave it out; it is 0.05 m in all sets of com1DFA"},
    {"solve.base.separation separation_depth_m",
     "Leave it out; a flow leaves its bed where it would fly higher than half its depth"},
    {"solve.base.slowest_froude", "Leave it out; it is flow_rule_slope"},
    {"solve.base.table_speed_m_s table_coefficient", "Give table = [[speed, coefficient], ...]"},
    {"solve.base.weakening_number", "Leave it out; it is 0.222 in all sets of com1DFA"},
    {"solve.gauge.x_m y_m", "Give at_m = [x, y]"},
    {"solve.implicit.apex", "Leave it out; the tip is rounded over a tenth of the weight of a cell"},
    {"solve.implicit.filler", "Leave it out; it is a thousandth of the stiffness of a full cell"},
    {"solve.implicit.forcing", "Give linear_tolerance"},
    {"solve.implicit.linear_iterations", "Leave it out; 5000 at most. linear_solver = \"cholesky\" takes none"},
    {"solve.implicit.linear_solver=bicgstab", "Take linear_solver = \"pcg\""},
    {"solve.implicit.newton_iterations", "Leave it out; 30 at most, and preset = \"reference\" takes one"},
    {"solve.implicit.newmark_alpha newmark_beta", "Give newmark = [alpha, beta]"},
    {"solve.implicit.operator", "Leave it out; the product goes point by point"},
    {"solve.implicit.preconditioner", "Leave it out; it is the 3 x 3 block of each node"},
    {"solve.implicit.step_cuts", "Leave it out; a step is halved 8 times at most"},
    {"solve.implicit.tangent", "Leave it out; the tangent is symmetric, with the yield stress held"},
    {"solve.inflow.times_s discharges_m3_s", "Give hydrograph = [[time, discharge], ...]"},
    {"solve.inflow.x_m y_m", "Give line_m = [[x, y], [x, y]]"},
    {"solve.load.from_s to_s", "Give during_s = [from, to]"},
    {"solve.load.box_m", "Give extent_m = [west, south, east, north, bottom, top]; the order is another"},
    {"solve.material.fast_friction_rise", "Leave it out; it is 0.05 (Barker & Gray 2017)"},
    {"solve.material.stiffness_check", "Run an error budget, which varies the modulus"},
    {"solve.material.stiffness_strain", "Leave it out; accuracy of [solve] settles it"},
    {"solve.material.volume_fraction_slope", "Leave it out; it is 0.2 (Forterre & Pouliquen 2008)"},
    {"solve.part.fast_friction_rise", "Leave it out; it is 0.05 (Barker & Gray 2017)"},
    {"solve.part.stiffness_check", "Run an error budget, which varies the modulus"},
    {"solve.part.stiffness_strain", "Leave it out; accuracy of [solve] settles it"},
    {"solve.part.volume_fraction_slope", "Leave it out; it is 0.2 (Forterre & Pouliquen 2008)"},
    {"solve.section.x_m y_m", "Give line_m = [[x, y], [x, y]]"},
    {"solve.stability.critical_share", "Leave it out; points that go half as far as the mean belong to the mass"},
    {"solve.stability.largest_factor", "Leave it out; the search ends at 20"},
    {"solve.wall.from_s", "Leave it out; walls stand from the start"},
};

/// The length of "table." in "table.key=word".
std::size_t table_length(std::string_view place) { return place.substr(0, place.find('=')).rfind('.') + 1; }

/// True if `place` is one of those of a row.
bool holds(std::string_view places, std::string_view place) {
  const std::size_t end = std::min(places.find(' '), places.size()), table = table_length(places.substr(0, end));
  if (place.substr(0, table) != places.substr(0, table) || table_length(place) != table) return false;
  const std::string key = fmt::format(" {} ", place.substr(table));
  return fmt::format(" {} ", places.substr(table)).find(key) != std::string::npos;
}

}  // namespace

std::string_view advice_on_gone(std::string_view place) {
  for (const GoneKeys& gone : gone_keys)
    if (holds(gone.places, place)) return gone.advice;
  return {};
}

}  // namespace talus::recipe
