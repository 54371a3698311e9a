// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps a run hands on, as rasters; names and texts as files have them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// The maps that this run has and that are written as GeoTIFF, in the order of the table map_fields; without those by
/// release.
std::vector<MapField> product_fields(const RunMaps& maps);

/// A map by its name in the table map_fields. Throws std::logic_error for a name that is not in it.
const MapField& map_field(std::string_view name);

/// True where the run has ground, or mass in spite of it: there zero is a value; elsewhere it is nodata.
std::vector<char> inside_domain(const RunMaps& maps);

/// One field as a raster: NaN outside the domain, 0 inside it where nothing is (arrival time: NaN).
Raster field_raster(const RunMaps& maps, const MapField& field);

/// Values on the run's grid as a raster: NaN outside the domain; with `zero_inside` 0 for NaN inside it.
Raster values_raster(const RunMaps& maps, const std::vector<double>& values, bool zero_inside);

/// A name as part of a file's: letters, digits, dots and dashes, "-" for anything else.
std::string file_word(const std::string& name);

/// Those of several names, in their order: where two would be the same, the later one ends in "-2", "-3", ...
std::vector<std::string> file_words(const std::vector<std::pair<std::string, std::vector<double>>>& named);

/// A text as a field of comma-separated values: quoted where it holds what separates fields, its line breaks made
/// spaces.
std::string csv_field(std::string text);

/// Volume under a thickness raster, NaN as nothing [m3]. Summed in extended precision: it is compared to 1e-9.
double volume_under(const std::vector<double>& thickness, double cell);

}  // namespace talus::postprocess
