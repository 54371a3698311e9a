// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of a run, in one table: what each holds, in which unit, where it is written and how it is drawn. A new map
// is a member and a row here, and a line in the kernel or recorder that fills it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/map/colours.hpp"
#include "common/map/raster.hpp"

namespace talus {

/// Maps that kernels keep while a run goes on, in SI, [rows * columns] each. `Values` is how they are held: pointers in
/// kernels, buffers beside them, arrays in a checkpoint.
template <class Values>
struct RunningMaps {
  Values peak_thickness{};  // running maximum [m]
  Values peak_speed{};      // largest speed of the mean motion of a column's points [m/s]
  Values peak_pressure{};   // running maximum of rho v^2 [Pa]
  Values arrival_time{};    // first time thicker than the threshold [s]; negative: not yet
  // Of the water in the pores at the bed; empty where there is none.
  Values peak_pore_pressure{};  // running maximum over the load on the bed [-]
  Values effective_stress{};    // as water flowed last [Pa]
  Values grains_share{};        // of the normal stress, as water flowed last: what friction acts on [-]
  Values drained_time{};        // last time at which the excess was above a tenth of the load [s]
  Values ground{};              // vertical depth of erodible ground that is left; empty where its strength decides [m]
};

/// Running maps whose values are each made from the same arguments.
template <class Values, class... Arguments>
RunningMaps<Values> make_running_maps(const Arguments&... arguments) {
  return {.peak_thickness = Values(arguments...),
          .peak_speed = Values(arguments...),
          .peak_pressure = Values(arguments...),
          .arrival_time = Values(arguments...),
          .peak_pore_pressure = Values(arguments...),
          .effective_stress = Values(arguments...),
          .grains_share = Values(arguments...),
          .drained_time = Values(arguments...),
          .ground = Values(arguments...)};
}

/// The maps of a finished run as run.h5 holds them, [rows * columns] each, row 0 southernmost. Thickness is vertical
/// and counts released volume (mass over initial density), so that its integral closes exactly.
struct RunMaps {
  MapGrid grid;
  std::vector<double> terrain;            // bed [m], NaN outside the domain
  std::vector<double> before;             // surface before the failure [m]
  std::vector<double> initial_thickness;  // [m]
  std::vector<double> deposit_thickness;  // at the end, without what still lies where it was eroded from [m]
  std::vector<double> peak_thickness;     // running maximum [m]
  std::vector<double> peak_speed;         // largest speed of the mean motion of a column's points [m/s]
  std::vector<double> peak_pressure_kPa;  // running maximum of rho v^2 [kPa]
  std::vector<double> arrival_time;       // [s], NaN where it never came
  std::vector<double> eroded_depth;       // of the ground that was eroded [m]; empty where nothing can be
  // Of the water in the pores at the bed; empty where there is none.
  std::vector<double> peak_pore_pressure;    // running maximum over the load on the bed [-]
  std::vector<double> effective_stress_kPa;  // at the end [kPa]
  std::vector<double> drained_time;          // last time at which the excess was above a tenth of the load [s]
  // Of a search for the factor of safety; empty in runs in time.
  std::vector<double> critical_thickness;    // of the mass that fails first [m]
  std::vector<double> failure_displacement;  // of a column's points as it fails, over the way of that mass [-]
  std::vector<std::pair<std::string, std::vector<double>>>
      deposit_of;        // deposit_thickness by release, where there are several [m]
  double threshold = 0;  // thickness from which speed, pressure and arrival count [m]
};

/// One of the maps of RunMaps. (Under a name, since nvcc writes a bare pointer to a member in a way that GCC warns of.)
using MapMember = std::vector<double> RunMaps::*;

/// Whose maps they are: those of other runs are empty.
enum class MapsOf { every_run, water_in_pores, erosion_by_rate };

/// One of the RunningMaps, and the map of the finished run that it becomes.
struct RunningMap {
  const char* name;  ///< in checkpoints
  double start;      ///< its value before anything moved
  MapMember result;  ///< where it ends; negative values (not yet) become NaN there; null: nowhere
  double unit;       ///< SI units in one unit of the result: 1000 for kPa
  MapsOf of = MapsOf::every_run;
};

/// Calls visit(row, maps.member...) for every one of the RunningMaps, with the same member of all `maps`.
template <class Visit, class... Maps>
void for_each_running_map(Visit&& visit, Maps&&... maps) {
  visit(RunningMap{"peak_thickness", 0, &RunMaps::peak_thickness, 1}, maps.peak_thickness...);
  visit(RunningMap{"peak_speed", 0, &RunMaps::peak_speed, 1}, maps.peak_speed...);
  visit(RunningMap{"peak_pressure", 0, &RunMaps::peak_pressure_kPa, 1000}, maps.peak_pressure...);
  visit(RunningMap{"arrival_time", -1, &RunMaps::arrival_time, 1}, maps.arrival_time...);
  constexpr MapsOf water = MapsOf::water_in_pores;
  visit(RunningMap{"peak_pore_pressure", 0, &RunMaps::peak_pore_pressure, 1, water}, maps.peak_pore_pressure...);
  visit(RunningMap{"effective_stress", 0, &RunMaps::effective_stress_kPa, 1000, water}, maps.effective_stress...);
  visit(RunningMap{"grains_share", 1, nullptr, 1, water}, maps.grains_share...);
  visit(RunningMap{"drained_time", -1, &RunMaps::drained_time, 1, water}, maps.drained_time...);
  visit(RunningMap{"ground", 0, nullptr, 1, MapsOf::erosion_by_rate}, maps.ground...);
}

/// What the classes of a map are, and so its colours.
enum class MapClasses { thickness, speed, pressure, time, share };

/// What stands for several cells that are shown as one.
enum class MergedCells { mean, largest, smallest };

/// A map among the products: GeoTIFF, NetCDF, and a layer of the GIS project.
struct MapProduct {
  const char* title = "";         ///< long_name of GeoTIFF and NetCDF; "" = the meaning
  const char* netcdf_name = "";   ///< "" = the name
  const char* cell_methods = "";  ///< CF; "" = none
  const char* legend = "";        ///< in the GIS project, with the unit; "" = no GeoTIFF
  MapClasses classes = MapClasses::thickness;
  bool in_netcdf = true;
  bool zero_inside = true;  ///< no data inside the domain means zero (not so of a time: it never came)
};

struct MapLayer {
  const char* id = "";     ///< "" = not in the report
  const char* title = "";  ///< in the list of layers
  const char* unit = "m";  ///< as people write it
  const char* about = "";  ///< a sentence; "{:g}" in it stands for the run's threshold [m]
  int decimals = 2;
  MergedCells merge = MergedCells::largest;
  Ramp ramp = Ramp::heat;
};

/// One of the RunMaps, wherever it goes.
struct MapField {
  const char* name;        ///< in run.h5, and the GeoTIFF's file name
  MapMember values;        ///< in the unit below
  const char* unit = "m";  ///< in UDUNITS' words: "m s-1"
  const char* meaning;     ///< long_name in run.h5
  bool optional = false;   ///< empty in runs that have none
  MapProduct product = {};
  MapLayer layer = {};

  const char* title() const { return product.title[0] == '\0' ? meaning : product.title; }
  const char* netcdf_name() const { return product.netcdf_name[0] == '\0' ? name : product.netcdf_name; }
};

/// All maps of a run, in the order in which they are written; those by release (deposit_of) as deposit_thickness.
inline constexpr MapField map_fields[] = {
    {.name = "deposit_thickness",
     .values = &RunMaps::deposit_thickness,
     .meaning = "thickness at the end, vertical",
     .product = {.title = "deposit thickness at the end, vertical",
                 .cell_methods = "area: mean",
                 .legend = "Deposit thickness, vertical [m]"},
     .layer = {.id = "deposit",
               .title = "Deposit thickness",
               .about = "Thickness at the end of the run, vertical.",
               .merge = MergedCells::mean}},
    {.name = "peak_thickness",
     .values = &RunMaps::peak_thickness,
     .meaning = "largest thickness over time, vertical",
     .product = {.title = "peak thickness, vertical",
                 .cell_methods = "area: mean time: maximum",
                 .legend = "Peak thickness, vertical [m]"},
     .layer = {.id = "peak_thickness", .title = "Peak thickness", .about = "Largest thickness over time, vertical."}},
    {.name = "peak_speed",
     .values = &RunMaps::peak_speed,
     .unit = "m s-1",
     .meaning = "largest depth-mean speed over time",
     .product = {.title = "peak of the depth-mean speed",
                 .cell_methods = "time: maximum",
                 .legend = "Peak speed [m/s]",
                 .classes = MapClasses::speed},
     .layer = {.id = "peak_speed",
               .title = "Peak speed",
               .unit = "m/s",
               .about = "Largest depth-mean speed over time, where the flow was thicker than {:g} m.",
               .decimals = 1,
               .ramp = Ramp::sea}},
    {.name = "peak_pressure",
     .values = &RunMaps::peak_pressure_kPa,
     .unit = "kPa",
     .meaning = "largest rho v^2 over time",
     .product = {.title = "peak flow pressure, density times speed squared",
                 .cell_methods = "time: maximum",
                 .legend = "Peak pressure [kPa]",
                 .classes = MapClasses::pressure},
     .layer = {.id = "peak_pressure",
               .title = "Peak pressure",
               .unit = "kPa",
               .about = "Largest density times speed squared over time, where the flow was thicker than {:g} m.",
               .decimals = 1}},
    {.name = "arrival_time",
     .values = &RunMaps::arrival_time,
     .unit = "s",
     .meaning = "time of first arrival",
     .product = {.title = "time from the start to the first arrival",
                 .legend = "Arrival time [s]",
                 .classes = MapClasses::time,
                 .zero_inside = false},
     .layer = {.id = "arrival",
               .title = "Arrival time",
               .unit = "s",
               .about = "When the flow first was thicker than {:g} m.",
               .decimals = 1,
               .merge = MergedCells::smallest}},
    {.name = "initial_thickness",
     .values = &RunMaps::initial_thickness,
     .meaning = "thickness at the start, vertical",
     .product = {.cell_methods = "area: mean"},
     .layer = {.id = "release",
               .title = "Release thickness",
               .about = "Thickness at the start, vertical.",
               .merge = MergedCells::mean}},
    {.name = "terrain",
     .values = &RunMaps::terrain,
     .meaning = "elevation of the bed",
     .product = {.netcdf_name = "bed_elevation", .cell_methods = "area: mean", .zero_inside = false}},
    {.name = "before",
     .values = &RunMaps::before,
     .meaning = "elevation of the surface before the failure",
     .product = {.in_netcdf = false}},
    {.name = "eroded_depth",
     .values = &RunMaps::eroded_depth,
     .meaning = "depth of ground that went along, vertical",
     .optional = true,
     .product = {.cell_methods = "area: mean", .legend = "Depth of erosion, vertical [m]"},
     .layer = {.id = "eroded",
               .title = "Eroded depth",
               .about = "Depth of the ground that went along, vertical.",
               .merge = MergedCells::mean,
               .ramp = Ramp::sea}},
    {.name = "peak_pore_pressure",
     .values = &RunMaps::peak_pore_pressure,
     .unit = "1",
     .meaning = "largest pore pressure at the bed over the load on it",
     .optional = true,
     .product = {.cell_methods = "time: maximum",
                 .legend = "Peak pore pressure over the load [-]",
                 .classes = MapClasses::share},
     .layer = {.id = "pore_pressure",
               .title = "Peak pore pressure",
               .unit = "",
               .about = "Largest pressure of the water at the bed over the load on it; 1: liquefied.",
               .ramp = Ramp::sea}},
    {.name = "effective_stress",
     .values = &RunMaps::effective_stress_kPa,
     .unit = "kPa",
     .meaning = "effective normal stress on the bed at the end",
     .optional = true,
     .product = {.cell_methods = "area: mean",
                 .legend = "Effective stress on the bed [kPa]",
                 .classes = MapClasses::pressure},
     .layer = {.id = "effective_stress",
               .title = "Effective stress",
               .unit = "kPa",
               .about = "Normal stress between grains and bed at the end, without what water carries.",
               .decimals = 1,
               .merge = MergedCells::mean}},
    {.name = "drained_time",
     .values = &RunMaps::drained_time,
     .unit = "s",
     .meaning = "last time at which excess pore pressure carried a tenth of the load on the bed",
     .optional = true,
     .product = {.legend = "Drained from [s]", .classes = MapClasses::time, .zero_inside = false},
     .layer = {.id = "drained",
               .title = "Drained from",
               .unit = "s",
               .about = "Last time at which excess pore pressure carried a tenth of the load on the bed.",
               .decimals = 1}},
    {.name = "critical_thickness",
     .values = &RunMaps::critical_thickness,
     .meaning = "thickness of the mass that fails first, vertical",
     .optional = true,
     .product = {.cell_methods = "area: mean", .legend = "Critical mass, vertical thickness [m]"},
     .layer = {.id = "critical",
               .title = "Critical mass",
               .about = "Thickness of the mass that fails first as strength is lowered, vertical.",
               .merge = MergedCells::mean}},
    {.name = "failure_displacement",
     .values = &RunMaps::failure_displacement,
     .unit = "1",
     .meaning = "displacement at failure over that of the mass that fails",
     .optional = true,
     .product = {.cell_methods = "area: mean",
                 .legend = "Displacement at failure, share [-]",
                 .classes = MapClasses::share},
     .layer = {.id = "failure",
               .title = "Displacement at failure",
               .unit = "",
               .about = "Mean displacement of the ground under a place as it fails, over that of the mass that fails.",
               .merge = MergedCells::mean,
               .ramp = Ramp::sea}},
};

}  // namespace talus
