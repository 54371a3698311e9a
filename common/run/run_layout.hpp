// Names in run.h5, in one place for the writer and the reader.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::run_layout {

inline constexpr const char* format = "talus-run";
inline constexpr std::int64_t format_version = 3;

struct MapField {
  const char* name;
  std::vector<double> RunMaps::*values;
  const char* unit;
  const char* long_name;
};

inline constexpr MapField map_fields[] = {
    {"terrain", &RunMaps::terrain, "m", "elevation of the bed"},
    {"before", &RunMaps::before, "m", "elevation of the surface before the failure"},
    {"initial_thickness", &RunMaps::initial_thickness, "m", "thickness at the start, vertical"},
    {"deposit_thickness", &RunMaps::deposit_thickness, "m", "thickness at the end, vertical"},
    {"peak_thickness", &RunMaps::peak_thickness, "m", "largest thickness over time, vertical"},
    {"peak_speed", &RunMaps::peak_speed, "m s-1", "largest depth-mean speed over time"},
    {"peak_pressure", &RunMaps::peak_pressure, "kPa", "largest rho v^2 over time"},
    {"arrival_time", &RunMaps::arrival_time, "s", "time of first arrival"},
};

template <class T>
struct SummaryItem {
  const char* name;
  T RunSummary::*value;
};

inline constexpr SummaryItem<std::string> summary_texts[] = {
    {"scene", &RunSummary::scene},         {"title", &RunSummary::title},     {"on", &RunSummary::on},
    {"precision", &RunSummary::precision}, {"version", &RunSummary::version}, {"stop_reason", &RunSummary::stop_reason},
};
inline constexpr SummaryItem<std::int64_t> summary_integers[] = {{"particles", &RunSummary::particles},
                                                                 {"particles_outflow", &RunSummary::particles_outflow},
                                                                 {"steps", &RunSummary::steps}};
inline constexpr SummaryItem<double> summary_numbers[] = {
    {"time_end_s", &RunSummary::time_end},
    {"wall_time_s", &RunSummary::wall_time},
    {"memory_bytes", &RunSummary::memory},
    {"density_kg_m3", &RunSummary::density},
    {"volume_released_m3", &RunSummary::volume_released},
    {"volume_entrained_m3", &RunSummary::volume_entrained},
    {"volume_final_m3", &RunSummary::volume_final},
    {"volume_outflow_m3", &RunSummary::volume_outflow},
};

}  // namespace talus::run_layout
