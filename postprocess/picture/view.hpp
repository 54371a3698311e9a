// Which part of the map is shown, and where its coordinates fall on the picture.
#pragma once

#include "common/run/run_file.hpp"
#include "postprocess/options.hpp"
#include "postprocess/picture/canvas.hpp"
#include "postprocess/score/survey.hpp"

namespace talus::postprocess {

/// A rectangle in map coordinates [m].
struct Window {
  double west = 0, south = 0, east = 0, north = 0;
  double width() const { return east - west; }
  double height() const { return north - south; }
};

/// Everything affected, released or surveyed, with a margin, inside the run's grid; not more slender than 5:8 where the
/// grid allows. The whole grid where nothing happened.
Window affected_window(const RunMaps& maps, const Options& options, const std::optional<Survey>& survey);

/// The maps the picture draws (before, initial, deposit and peak thickness), cut to the window and two cells around it.
RunMaps cropped(const RunMaps& maps, const Window& window);

/// Map coordinates to pixels.
struct View {
  Window window;
  Box box;                                                     // on the canvas
  double scale() const { return box.width / window.width(); }  // [px/m]
  std::array<double, 2> pixel(double x, double y) const {
    return {box.x + (x - window.west) * scale(), box.y + (window.north - y) * scale()};
  }
};

/// A round number (1, 2 or 5 times a power of ten) that is at most `limit`.
double round_below(double limit);

}  // namespace talus::postprocess
