// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Names in run.h5, in one place for the writer and the reader.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "common/run/sealed_file.hpp"

namespace talus::run_layout {

inline constexpr h5::Format format{"talus-run", "a run of Talus"};

/// A member of RunSummary and the attribute that holds it.
template <class T>
struct SummaryItem {
  const char* name;
  T RunSummary::*value;
};

inline constexpr SummaryItem<std::string> summary_texts[] = {
    {"scene", &RunSummary::scene},         {"title", &RunSummary::title},     {"on", &RunSummary::on},
    {"precision", &RunSummary::precision}, {"version", &RunSummary::version}, {"stop_reason", &RunSummary::stop_reason},
    {"material", &RunSummary::material},   {"bed", &RunSummary::bed},
};
/// The attribute for RunSanity::words.
inline constexpr const char* sanity_words = "sanity";
inline constexpr SummaryItem<std::int64_t> summary_integers[] = {{"particles", &RunSummary::particles},
                                                                 {"particles_outflow", &RunSummary::particles_outflow},
                                                                 {"steps", &RunSummary::steps}};
inline constexpr SummaryItem<double> summary_numbers[] = {
    {"time_end_s", &RunSummary::time_end},
    {"layer_height_m", &RunSummary::layer_height},
    {"wall_time_s", &RunSummary::wall_time},
    {"memory_bytes", &RunSummary::memory},
    {"density_kg_m3", &RunSummary::density},
    {"volume_released_m3", &RunSummary::volume_released},
    {"volume_entrained_m3", &RunSummary::volume_entrained},
    {"volume_final_m3", &RunSummary::volume_final},
    {"volume_outflow_m3", &RunSummary::volume_outflow},
};

/// The list for RunSummary::release_density; only there where a run has releases.
inline constexpr const char* release_density = "/release_density_kg_m3";

}  // namespace talus::run_layout
