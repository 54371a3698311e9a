// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Peak maps as AvaFrame's AIMEC and the ISeeSnow intercomparison name and measure them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// Raster format: all versions of AvaFrame read .asc, newer ones .tif too.
enum class AvaFrameFormat { tif, asc };

/// What the run was made with, a line each, the same on every machine: the options in solve.used.toml beside `run_file`
/// (where it lies there), and from the run's provenance all but command, hardware, version and the inputs' folders.
std::string settings_text(const Run& run, const std::filesystem::path& run_file);

/// relSCENE_HASH_C_SIZE_TYPE_mpm, AvaFrame's name of a simulation (release, ten digits of the settings' SHA-256, C for
/// changed settings; S, M or L by the released volume below 25 000 m3, below 60 000 m3 or above, AvaFrame's own limits;
/// "ent" with erodible ground or "null"; the model). Underscores stand between the parts alone.
std::string avaframe_name(const Run& run, const std::string& settings);

/// Thickness normal to the slope from a vertical one: times the cosine of the bed's slope. [rows * columns], m
std::vector<double> normal_thickness(const RunMaps& maps, const std::vector<double>& vertical);

/// Write into `folder`: NAME_ppr (peak pressure, kPa), NAME_pft (peak thickness normal to the slope, m), NAME_pfv (peak
/// speed, m/s), and NAME.txt, the settings. Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_avaframe(const std::filesystem::path& folder, const Run& run,
                                                  const std::string& settings, AvaFrameFormat format);

}  // namespace talus::postprocess
