// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Names in run.h5, in one place for the writer and the reader.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::run_layout {

inline constexpr const char* format = "talus-run";
/// Raised when a reader of today would misread the file or miss something in it; the version before is read as well
/// (docs/reference/formats.md). 4: sealed (common/stage/checksum.hpp). 3: the same without a seal.
inline constexpr std::int64_t format_version = 4;
inline constexpr std::int64_t oldest_version = 3;

/// A member of RunSummary and the attribute that holds it.
template <class T>
struct SummaryItem {
  const char* name;
  T RunSummary::*value;
};

inline constexpr SummaryItem<std::string> summary_texts[] = {
    {"scene", &RunSummary::scene},         {"title", &RunSummary::title},     {"on", &RunSummary::on},
    {"precision", &RunSummary::precision}, {"version", &RunSummary::version}, {"stop_reason", &RunSummary::stop_reason},
};
/// Words that files of earlier versions lack.
inline constexpr SummaryItem<std::string> summary_laws[] = {{"material", &RunSummary::material},
                                                            {"bed", &RunSummary::bed}};
/// The attribute for RunSanity::words; files of earlier versions lack it and the numbers beside it (run_sanity.hpp).
inline constexpr const char* sanity_words = "sanity";
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

/// The attribute for RunSummary::layer_height and the list for release_density; files of earlier versions lack them.
inline constexpr const char* layer_height = "layer_height_m";
inline constexpr const char* release_density = "/release_density_kg_m3";

}  // namespace talus::run_layout
