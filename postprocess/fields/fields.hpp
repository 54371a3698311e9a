// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps a run hands on, as rasters, with their classes and styles, and which part of them is shown; names and texts
// as files have them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/map/colours.hpp"
#include "common/qgis/style.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// The maps of this run that are written as GeoTIFF, in the order of map_fields; without those by release.
std::vector<MapField> product_fields(const RunMaps& maps);

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

/// A text as a field of comma-separated values: quoted where it holds a separator, its line breaks made spaces. One
/// that a spreadsheet would compute ("=1+1") begins with an apostrophe.
std::string csv_field(std::string text);

/// Volume under a thickness raster, NaN as nothing [m3]. Summed in extended precision: it is compared to 1e-9.
double volume_under(const std::vector<double>& thickness, double cell);

/// A release of vertical thickness t, on cells of map area A and of slope s.
struct ReleaseNumbers {
  double volume_if_normal = 0;     ///< sum of t A / cos s: were t normal to the slope [m3]
  double area = 0, true_area = 0;  ///< sum of A, and of A / cos s, where t > 0 [m2]
  double thickest = 0;             ///< [m]
  double thickest_normal = 0;      ///< t cos s [m]
};

/// The numbers of a thickness map on ground of slopes with these cosines; areas are of cells thicker than `limit` [m].
ReleaseNumbers numbers_of(const Raster& thickness, const std::vector<double>& cosine, double limit);

/// As talus-preprocess measured it on the release itself; of a run that does not carry it on (an older one) from the
/// map of the thickness at the start, spread by the shape functions, over cells thicker than `limit` [m].
ReleaseNumbers release_numbers(const Run& run, double limit);

/// Lower limits of thickness classes [m]: as given; if none are, of 0.1|0.5|1|2|5|10|25|50|100|200|500 those that fit.
std::vector<double> class_limits(const std::vector<double>& given, double thickest);

/// Largest of the positive values, NaN left out; 0 if there is none.
double largest(const std::vector<double>& values);

/// Index of the class that holds the value; -1 below the first limit or for NaN.
int class_of(double value, const std::vector<double>& limits);

/// A round number (1, 2 or 5 times a power of ten) that is at most `limit`.
double round_below(double limit);

/// Limits of pressure classes [kPa]: of 1|3|5|10 and the powers of ten above those that fit the largest of `values`
/// (fitting_limits), the first four always kept.
std::vector<double> pressure_limits(const std::vector<double>& values);

/// Limits of speed classes [m/s]: of 0.5|1|5|10|25|50|100 those that fit the largest of `values` (fitting_limits).
std::vector<double> speed_limits(const std::vector<double>& values);

/// Limits of thickness classes for `values` [m]: as given in the recipe, or by the thickest of them.
std::vector<double> thickness_limits(const std::vector<double>& given, const std::vector<double>& values);

/// Round times up to the last of `values` [s], six at most.
std::vector<double> time_limits(const std::vector<double>& values);

/// Class limits of a map of the run; `given_classes` are the thickness classes of the recipe, empty = none.
std::vector<double> map_limits(const MapField& field, const RunMaps& maps, const std::vector<double>& given_classes);

/// The style of a map by its name (file name without extension); `given_classes` are those of the recipe. Throws
/// std::logic_error for a name that is no map of a run.
RasterStyle map_style(const std::string& name, const RunMaps& maps, const std::vector<double>& given_classes);

/// How many decimals a threshold is written with: two, and more where it takes them to show two digits [m].
int threshold_decimals(double threshold);

/// A rectangle in map coordinates [m].
struct Window {
  double west = 0, south = 0, east = 0, north = 0;
  double width() const { return east - west; }     ///< [m]
  double height() const { return north - south; }  ///< [m]
};

/// All that a map colours or outlines and all that moved, was released or surveyed (of a change with an error, what is
/// no noise), with a margin, inside the run's grid; not more slender than 5:8 where the
/// grid allows. The whole grid where nothing happened.
Window affected_window(const RunMaps& maps, const Options& options, const std::optional<Survey>& survey);

/// What the map of a page shows: that window, as wide as it is high where the map goes on that far.
Window page_window(const RunMaps& maps, const Options& options, const std::optional<Survey>& survey);

/// The maps the picture draws (before, initial, deposit and peak thickness), cut to the window and two cells around it.
RunMaps cropped(const RunMaps& maps, const Window& window);

}  // namespace talus::postprocess
