// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/picture/map_picture.hpp"

#include <algorithm>
#include <cmath>

#include "postprocess/fields/classes.hpp"
#include "postprocess/picture/furniture.hpp"
#include "postprocess/picture/layers.hpp"
#include "postprocess/picture/search_words.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

// All in pixels at 200 dpi.
constexpr double left = 120, top = 172, right = 40, bottom = 118;
constexpr double gap = 36, sidebar = 470;
constexpr double largest_width = 1560, largest_height = 1420, least_height = 1130;

Box map_box(const Window& window) {
  const double scale = std::min(largest_width / window.width(), largest_height / window.height());
  return {left, top, std::round(window.width() * scale), std::round(window.height() * scale)};
}

/// The part of the maps that is drawn; at an instant the flow takes the deposit's place, after a search what fails
/// first.
RunMaps shown_maps(const PictureInput& input, const Window& window) {
  const bool search = shows_search(input);
  if (!input.instant && !search) return cropped(input.run.maps, window);
  auto maps = input.run.maps;
  maps.deposit_thickness = search ? maps.critical_thickness : input.instant->thickness;
  if (search) maps.peak_thickness.assign(maps.peak_thickness.size(), 0);  // nothing has moved
  return cropped(maps, window);
}

class PictureWriter : public Writer {
 public:
  std::string name() const override { return "map picture"; }
  std::vector<std::string> names() const override { return {"map.png"}; }
  std::vector<std::string> outdated() const override { return {}; }
  bool stands_alone() const override { return true; }
  Files write(const Job& job) const override { return {write_file(job, "map.png", map_picture(picture_of(job)))}; }
};

}  // namespace

std::shared_ptr<Writer> picture_writer() { return std::make_shared<PictureWriter>(); }

PictureInput picture_of(const Job& job) { return {job.run, job.options, job.survey, job.score, {}, &job.hazard}; }

std::string map_picture(const PictureInput& input) { return draw_map(input).png(); }

Canvas draw_map(const PictureInput& input) {
  const auto window = affected_window(input.run.maps, input.options, input.survey);
  const View view{window, map_box(window)};
  const auto maps = shown_maps(input, window);
  const auto limits =
      class_limits(input.options.classes, input.instant ? input.instant->thickest : largest(maps.deposit_thickness));
  const ContourLevels contours = contour_levels(view, maps);
  const double width = left + view.box.width + gap + sidebar + right;
  const double height = top + std::max(view.box.height, least_height) + bottom;

  Canvas canvas(static_cast<int>(width), static_cast<int>(height));
  canvas.clip(view.box);
  draw_ground(canvas, view, maps, limits);
  draw_contours(canvas, view, maps, contours);
  draw_outlines(canvas, view, maps, input);
  if (input.hazard != nullptr) draw_hazard(canvas, view, input.run.maps.grid, *input.hazard);
  draw_places(canvas, view, input.run.summary.places);
  canvas.unclip();
  canvas.frame(view.box, {{0.1, 0.1, 0.12}, 2.5, {}, 1});
  draw_coordinates(canvas, view);
  draw_title(canvas, input, left, 30, width - left - right);
  draw_sidebar(canvas, input, view, limits, contours.interval,
               {left + view.box.width + gap, top, sidebar, height - top - bottom});
  draw_footer(canvas, input, left, height - 26);
  if (input.instant) draw_time(canvas, input.instant->time, view);
  return canvas;
}

}  // namespace talus::postprocess
