// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The map of a run as a picture: the canvas it is drawn on, what lies inside its frame, what stands around it.
// Coordinates of a canvas are pixels, y downwards. Cairo stays behind canvas.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

using Pixels = std::vector<std::array<double, 2>>;

/// How a line is drawn: colour, width [px], dashes [px].
struct Pen {
  Colour colour;
  double width = 1;
  std::vector<double> dashes;  // lengths on and off; empty = solid
  double opacity = 1;
};

/// Where a text stands beside its anchor.
enum class Align { left, centre, right };

/// How words are set: size [px], weight, colour, place beside the anchor, turn and rim.
struct TextStyle {
  double size = 24;
  bool bold = false;
  Colour colour;
  Align align = Align::left;
  double angle = 0;  // [rad], counter-clockwise
  double halo = 0;   // width of a white rim
};

/// A rectangle on the canvas [px], from its upper left corner.
struct Box {
  double x = 0, y = 0, width = 0, height = 0;
};

/// A picture being drawn.
class Canvas {
 public:
  Canvas(int width, int height);  ///< white
  Canvas(Canvas&& other) noexcept;
  ~Canvas();
  void line(const Pixels& points, const Pen& pen);
  void fill(const Pixels& points, const Colour& colour);
  void fill(const Box& box, const Colour& colour);  ///< likewise
  /// Draws the edge of a rectangle.
  void frame(const Box& box, const Pen& pen);
  /// Baseline at (x, y). Returns the width drawn.
  double text(const std::string& words, double x, double y, const TextStyle& style);
  /// The width of words if they were drawn [px].
  double text_width(const std::string& words, const TextStyle& style);
  /// Pixels 0xRRGGBB, row by row from the top, at (x, y).
  void image(int x, int y, int width, int height, const std::vector<std::uint32_t>& pixels);
  /// Limits all that is drawn from now on to a rectangle, until unclip().
  void clip(const Box& box);
  void unclip();
  /// The picture as a PNG file's bytes. Throws where something could not be drawn, as pixels() does.
  std::string png() const;
  /// The picture as bytes: blue, green, red and one that is not used, row by row from the top.
  std::string pixels() const;
  int width() const;   ///< [px]
  int height() const;  ///< [px]

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

struct Instant {
  double time = 0;                       // [s]
  const std::vector<double>& thickness;  // on the run's grid [m]
  double thickest = 0;                   // over all times, for the classes [m]
};

struct PictureInput {
  const Run& run;
  const Options& options;
  const std::optional<Survey>& survey;
  const Score& score;
  std::optional<Instant> instant{};  ///< show the flow then, and not the deposit
  const Hazard* hazard = nullptr;    ///< its outlines are drawn as well
};

/// The deposit map as a PNG file's bytes, made for 200 dpi: hillshade of the surface before the failure, thickness in
/// classes, outlines of release, footprint and survey, contours, and what stands around them.
std::string map_picture(const PictureInput& input);

/// Map coordinates to pixels.
struct View {
  Window window;
  Box box;                                                     // on the canvas
  double scale() const { return box.width / window.width(); }  ///< [px/m]
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

/// The outline of what was surveyed as touched; none where the survey has no footprint.
std::vector<Polyline> footprint_lines(const Survey& survey);

/// Line styles, shared by map and legend.
struct LineStyle {
  Pen casing;  // drawn first; width 0 = none
  Pen pen;
};
// Lines around what was surveyed (deposit, footprint), touched and released, buildings, what an angle of reach reaches.
inline const LineStyle survey_style{{{1, 1, 1}, 7, {}, 0.9}, {{0.0, 0.30, 0.70}, 4, {15, 9}, 1}};
inline const LineStyle survey_footprint_style{{{1, 1, 1}, 3.6, {}, 0.6}, {{0.0, 0.30, 0.70}, 1.8, {5, 4}, 1}};
inline const LineStyle footprint_style{{{1, 1, 1}, 3.6, {}, 0.6}, {{0.12, 0.12, 0.14}, 1.7, {}, 1}};
inline const LineStyle release_style{{{1, 1, 1}, 6, {}, 0.85}, {{0.0, 0.45, 0.36}, 3.2, {}, 1}};
inline const LineStyle building_style{{{1, 1, 1}, 4.4, {}, 0.8}, {{0.10, 0.10, 0.10}, 2.2, {}, 1}};
inline const LineStyle reach_style{{{1, 1, 1}, 4.4, {}, 0.7}, {{0.55, 0.10, 0.55}, 2.4, {10, 6}, 1}};

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

/// Draws gauges as dots and obstacles by their outlines inside the view, with their names if they are twelve or fewer.
void draw_places(Canvas& canvas, const View& view, const std::vector<MapPlace>& places);

/// The name of a place without its kind: "bridge" of "gauge bridge".
std::string name_of(const MapPlace& place);

/// Draws the title of the run, from (x, y), no wider than `width` [px].
void draw_title(Canvas& canvas, const PictureInput& input, double x, double y, double width);
/// Draws ticks and their coordinates along the edge of the map.
void draw_coordinates(Canvas& canvas, const View& view);

/// Everything in the column right of the map, from `y` downwards.
void draw_sidebar(Canvas& canvas, const PictureInput& input, const View& view, const std::vector<double>& limits,
                  double interval, const Box& box);

/// The time in the map's upper left corner.
void draw_time(Canvas& canvas, double time, const View& view);

/// What may be believed (score.belief) in lines no wider than `width` [px], and their distance [px].
std::vector<std::string> belief_lines(const Score& score, double width);
inline constexpr double belief_line = 30;

/// Draws these lines from (x, y) downwards.
void draw_belief(Canvas& canvas, const std::vector<std::string>& lines, double x, double y);

/// One line of small print.
void draw_footer(Canvas& canvas, const PictureInput& input, double x, double y);

/// "36.0 million m³", "22 500 m³": three figures, thousands apart.
std::string volume_words(double volume);

/// Whether the picture is that of a search: the mass that fails first is drawn in the deposit's place.
bool shows_search(const PictureInput& input);

/// Factor and mass in a line, for below the title.
std::string search_line(const PictureInput& input);

/// The same for the column beside the map: words and value; what the search did not find is left out.
std::vector<std::pair<std::string, std::string>> search_numbers(const PictureInput& input);

/// Shade of every cell, 0 dark to 1 bright; NaN where the elevation is. Slope after Horn (1981) from the eight
/// neighbours; light from 225, 270, 315 and 360 deg at 45 deg height, weighted by sin^2(aspect - azimuth) so that no
/// ridge drowns in the light along it (Mark 1992). Stretched between the 2nd and 98th percentile.
std::vector<double> hillshade(const MapGrid& grid, const std::vector<double>& elevation);

/// Bilinear between cell centres at (x, y), constant beyond the outermost; NaN neighbours count as `missing`.
double sample(const MapGrid& grid, const std::vector<double>& values, double x, double y, double missing);

}  // namespace talus::postprocess
