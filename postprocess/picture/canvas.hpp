// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A picture in memory, drawn with Cairo. Coordinates are pixels, y downwards. Cairo stays behind canvas.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "postprocess/fields/classes.hpp"

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
  /// Draws straight lines from point to point.
  void line(const Pixels& points, const Pen& pen);
  /// Fills an area with one colour.
  void fill(const Pixels& points, const Colour& colour);
  /// Fills an area with one colour.
  void fill(const Box& box, const Colour& colour);
  /// Draws the edge of a rectangle.
  void frame(const Box& box, const Pen& pen);
  /// Baseline at (x, y). Returns the width drawn.
  double text(const std::string& words, double x, double y, const TextStyle& style);
  /// The width of words if they were drawn [px].
  double text_width(const std::string& words, const TextStyle& style);
  /// Pixels 0xRRGGBB, row by row from the top, at (x, y).
  void image(int x, int y, int width, int height, const std::vector<std::uint32_t>& pixels);
  /// Limits all that is drawn from now on to a rectangle.
  void clip(const Box& box);
  /// Ends the limit that clip() set.
  void unclip();
  /// The picture as a PNG file's bytes. Throws where something could not be drawn, as pixels() does.
  std::string png();
  /// The picture as bytes: blue, green, red and one that is not used, row by row from the top.
  std::string pixels() const;
  /// Width of the picture [px].
  int width() const;  // [px]
  /// Height of the picture [px].
  int height() const;  // [px]

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace talus::postprocess
