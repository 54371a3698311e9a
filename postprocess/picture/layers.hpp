// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What lies inside the map's frame.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/map/isolines.hpp"
#include "common/map/places.hpp"
#include "common/map/polygon.hpp"
#include "postprocess/fields/window.hpp"
#include "postprocess/picture/canvas.hpp"
#include "postprocess/picture/map_picture.hpp"

namespace talus::postprocess {

/// Map coordinates to pixels.
struct View {
  Window window;
  Box box;  // on the canvas
  /// Pixels to a metre.
  double scale() const { return box.width / window.width(); }  // [px/m]
  /// The place of map coordinates (x, y) on the canvas [px].
  std::array<double, 2> pixel(double x, double y) const {
    return {box.x + (x - window.west) * scale(), box.y + (window.north - y) * scale()};
  }
};

/// A colour times a brightness.
Colour scaled(const Colour& c, double factor);

/// 0xRRGGBB.
std::uint32_t pixel_of(const Colour& c);

/// A line in map coordinates, in pixels.
Pixels on_canvas(const View& view, const Polyline& line);

/// All rings of the polygons as closed lines.
std::vector<Polyline> rings(const std::vector<MapPolygon>& polygons);

/// Line styles, shared by map and legend.
struct LineStyle {
  Pen casing;  // drawn first; width 0 = none
  Pen pen;
};
/// The line around the deposit that was surveyed.
LineStyle survey_style();
/// The line around the footprint that was surveyed.
LineStyle survey_footprint_style();
/// The line around what the flow touched.
LineStyle footprint_style();
/// The line around what was released.
LineStyle release_style();
/// The line around buildings.
LineStyle building_style();
/// The line around what an angle of reach reaches.
LineStyle reach_style();
/// The pen of contours; every fifth, an index contour, is heavier.
Pen contour_pen(bool is_index);

/// Hillshade and thickness classes, pixel by pixel.
void draw_ground(Canvas& canvas, const View& view, const RunMaps& maps, const std::vector<double>& limits);

/// Contours lie at `interval` [m] times the whole numbers from `first` to `last`; none where the interval is 0.
struct ContourLevels {
  double interval = 0;
  long first = 0, last = -1;
};

/// About a dozen contours over the relief inside the frame, without the hundredth of the cells that are highest and
/// lowest: a spike draws no more than some forty. None on a plain.
ContourLevels contour_levels(const View& view, const RunMaps& maps);

/// Contours at these levels, every fifth heavier and labelled.
void draw_contours(Canvas& canvas, const View& view, const RunMaps& maps, const ContourLevels& levels);

/// Outlines of the angle of reach and of buildings; obstacles are drawn among the places.
void draw_hazard(Canvas& canvas, const View& view, const MapGrid& grid, const Hazard& hazard);

/// Outlines: release, footprint, and the survey's deposit and footprint, or whichever of the two it has.
void draw_outlines(Canvas& canvas, const View& view, const RunMaps& maps, const PictureInput& input);

/// Draws gauges as dots and obstacles by their outlines, each with its name where they are no more than twelve; what
/// lies outside the view is left out.
void draw_places(Canvas& canvas, const View& view, const std::vector<MapPlace>& places);

/// The name of a place without its kind: "bridge" of "gauge bridge".
std::string name_of(const MapPlace& place);

}  // namespace talus::postprocess
