// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The line along which run-out is measured and profiles are drawn.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/mobility.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

using Polyline = std::vector<std::array<double, 2>>;  // [m]

/// Length along the line up to each vertex [m]. [line.size()]
std::vector<double> lengths_along(const Polyline& line);

/// A line with vertices at even distances, as near to `step` [m] as its length allows; ends stay.
Polyline resampled(const Polyline& line, double step);

/// Vertices averaged with their neighbours (1/4, 1/2, 1/4) so many times; ends stay. On vertices a step apart this is a
/// Gaussian of standard deviation step * sqrt(times / 2).
Polyline smoothed(Polyline line, int times);

/// Without the vertices nearer than `step` [m] to the one kept before, and without those that would turn the line by
/// more than a right angle. The first and the last stay.
Polyline without_returns(const Polyline& line, double step);

/// The cheapest way from cell to cell (eight neighbours; Dijkstra 1959) from one place to another, where a metre costs
/// the thickest value of the map over that of the cell: it keeps to the middle of the flow. Begins and ends at the
/// places themselves; one outside the grid is joined by a straight line.
Polyline flow_path(const MapGrid& grid, const std::vector<double>& thickness, const Place& from, const Place& to);

/// A line in map coordinates [m] from the crown downwards, vertices about one cell apart. Empty (no vertex) where a run
/// has neither release nor deposit and no line is given.
struct Thalweg {
  std::vector<std::array<double, 2>> line;
  std::vector<double> distance;  ///< along the line, of each vertex [m], from 0
  bool given = false;            ///< read from a file, not found
  std::string origin;            ///< how it came about, in words

  double length() const { return distance.empty() ? 0 : distance.back(); }  ///< [m]
};

/// The line of `[postprocess] thalweg`, turned so that it begins at its higher end, or else the path of the centre of
/// mass over the frames, carried on through the thickest flow to the crown and to the farthest deposit, simulated or
/// surveyed, and smoothed (the idea: Tonnel et al. 2023, AvaFrame com1DFA, mass-averaged path). Where the centre of
/// mass moves less than five cells or frames are missing, it is the way through the thickest flow from the crown to
/// there. Either line is carried on straight, which moves no place along it, as far as flow and survey reach. Throws
/// DataError: unreadable file, no line or several in it, a line that misses the run's area.
Thalweg thalweg_of(const Run& run, const Options& options, const std::optional<Survey>& survey = {});

/// `values` of `grid` at the line's vertices, bilinear; NaN outside the grid and where a cell has no value.
std::vector<double> sample_along(const Thalweg& thalweg, const MapGrid& grid, const std::vector<double>& values);

/// `values` with 0 in patches (cells above `threshold`, joined by eight neighbours) that hold no cell of `seeds`.
std::vector<double> patches_with(const MapGrid& grid, const std::vector<double>& values, double threshold,
                                 const std::vector<char>& seeds);

/// The cells of surveyed `values` above `threshold` that are no noise; all above it where none is sure, and of what is
/// no measured deposit or change.
std::vector<char> sure_cells(const Survey& survey, const std::vector<double>& values, double threshold);

/// The patches of surveyed values that hold a sure cell.
std::vector<double> sure_patches(const Survey& survey, const std::vector<double>& values, double threshold);

struct AlongLine {
  double distance = 0;  ///< along the line, of the nearest point of it [m]; beyond its ends the end segments go on
  double offset = 0;    ///< from the line, positive to the left looking downwards [m]
};
/// The place of map coordinates (x, y) beside the thalweg.
AlongLine project(const Thalweg& thalweg, double x, double y);

/// Distance along a line of the cells of a map, computed once for each cell that is asked for. Keeps references.
class DistancesAlong {
 public:
  DistancesAlong(const Thalweg& thalweg, const MapGrid& grid);
  double at(std::size_t cell);  ///< of the cell's centre [m]

 private:
  const Thalweg& thalweg_;
  const MapGrid& grid_;
  std::vector<double> known_;  // NaN: not asked for yet
};

/// A place, and how far along a line it lies [m].
struct PlaceAlong {
  Place place;
  double distance = 0;
};

/// The cell above `threshold` that lies farthest along the line; z is taken from `surface`, which has the same grid
/// (empty: z = 0). Empty where no cell exceeds the threshold or the line is empty.
std::optional<PlaceAlong> farthest_along(const Thalweg& thalweg, const MapGrid& grid, const std::vector<double>& values,
                                         double threshold, const std::vector<double>& surface);

/// What moves or has come to rest at a frame: its thickness without erodible ground that still lies in place [m].
std::vector<double> flow_thickness(const Run& run, std::size_t frame);

struct Series {
  std::vector<double> time;   ///< [s]
  std::vector<double> value;  ///< NaN where there is none
};

/// How far along the line the flow has come, from the map of arrival times, which every step of the run has filled: a
/// row for each advance by at least `step` [m], the first and the last among them. Empty where nothing arrived.
Series front_by_arrival(const RunMaps& maps, const Thalweg& thalweg, double step);

}  // namespace talus::postprocess
