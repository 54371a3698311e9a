// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The files that hold the maps and histories of a run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/gis/geotiff.hpp"
#include "common/gis/outlines.hpp"
#include "common/qgis/project.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/options/writer.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// Paths of the GeoTIFFs of a run: a map each, then the deposit of each release.
Files geotiff_files(const std::filesystem::path& folder, const RunMaps& maps);

/// Write every product field as FOLDER/NAME.tif (cloud-optimised). Returns the files. Throws DataError.
Files write_geotiffs(const std::filesystem::path& folder, const Run& run);

/// Metadata of a map: title, scene, run, quantity, source.
RasterTags plain_tags(const Run& run, const std::string& quantity, const std::string& unit);

/// Patterns of the maps' names in the output folder, with `end` (".tif") as extension.
std::vector<std::string> names_of_maps(const std::string& end);

/// From when time counts where nobody says when the failure began, UTC: CF asks for a date.
inline constexpr const char* nominal_start = "1970-01-01 00:00:00";

/// What a NetCDF file says of its making.
struct NetcdfNotes {
  std::string institution;   ///< empty: "not stated"
  std::string command_line;  ///< for history
  std::string start{};       ///< when the failure began, UTC, "1903-04-29 04:10:00"; empty: not known
};

/// Write `file` (aside, renamed): NetCDF-4 after CF-1.8, dimensions (time, y, x), y rising with row (south first), all
/// double with _FillValue -9999 and deflate (docs/reference/formats.md). Throws DataError (disk full).
void write_netcdf(const std::filesystem::path& file, const Run& run, const NetcdfNotes& notes);

/// Beside `maps`, the GeoTIFFs in `folder`: NAME.qml for each of them, terrain.tif (ground before the failure) with its
/// hillshade, outlines.gpkg and SCENE.qgs. Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_gis(const std::filesystem::path& folder,
                                             const std::vector<std::filesystem::path>& maps, const Job& job);

/// Layers `footprint`, `deposit` (above its threshold and the limits of the classes), `pressure` (above 1|3|5|10 kPa
/// and so on), `release` and, where there is one, `survey`.
std::vector<OutlineLayer> map_outlines(const Run& run, const Options& options, const std::optional<Survey>& survey);

/// The layers of a project that show them: outlines first, then rasters.
std::vector<ProjectGroup> hazard_groups(const Hazard& hazard);

/// For each kind of place that has columns ("gauge", "section"): a table with a row for every record and place.
std::vector<std::pair<std::string, std::string>> place_tables(const RunHistory& history);

/// The history as the bytes of a NetCDF-4 file after CF-1.8: a variable over `time` for every column, of places with
/// what is measured (`long_name`) and where (`place`). `start`: when the failure began, UTC; empty: not known.
std::string history_netcdf(const Run& run, const std::string& start);

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
