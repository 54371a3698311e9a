// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of a comparison shows: the difference of two deposits as a map, curves over time.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "common/gis/escaped_xml.hpp"
#include "common/map/polygon.hpp"
#include "postprocess/compare/compare.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/picture/picture.hpp"

namespace talus::postprocess {
namespace {

/// What is shown: wherever one of the two flows came, with a margin.
Window window_of(const RunMaps& first, const RunMaps& second, double threshold) {
  const double far = 1e30;
  Window window{far, far, -far, -far};
  for (const RunMaps* maps : {&first, &second}) {
    const MapGrid& grid = maps->grid;
    for (std::size_t i = 0; i < grid.count(); ++i) {
      if (!(maps->peak_thickness[i] > threshold)) continue;
      const auto [column, row] = grid.cell_of(i);
      window = {std::min(window.west, grid.x(column)), std::min(window.south, grid.y(row)),
                std::max(window.east, grid.x(column)), std::max(window.north, grid.y(row))};
    }
  }
  const MapGrid& grid = first.grid;
  if (window.west > window.east) return {grid.west, grid.south, grid.east(), grid.north()};
  const double margin = 0.08 * std::max(window.width(), window.height()) + 3 * grid.cell;
  return {std::max(window.west - margin, grid.west), std::max(window.south - margin, grid.south),
          std::min(window.east + margin, grid.east()), std::min(window.north + margin, grid.north())};
}

/// The colour of a difference, or white below the first class.
Colour colour_of(double difference, const std::vector<double>& limits) {
  const int index = class_of(std::abs(difference), limits);
  if (index < 0) return {1, 1, 1};
  return difference_colour(difference > 0, static_cast<std::size_t>(index), limits.size());
}

void draw_difference(Canvas& canvas, const View& view, const RunMaps& first, const DepositDifference& found) {
  const MapGrid& grid = first.grid;
  const auto shades = hillshade(grid, first.before);
  const auto limits = difference_limits(found);
  const int width = static_cast<int>(view.box.width), height = static_cast<int>(view.box.height);
  std::vector<std::uint32_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0xEDF0F2);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const double x = view.window.west + (i + 0.5) / view.scale(), y = view.window.north - (j + 0.5) / view.scale();
      const int column = static_cast<int>((x - grid.west) / grid.cell),
                row = static_cast<int>((y - grid.south) / grid.cell);
      if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) continue;
      if (std::isnan(first.before[grid.index(column, row)])) continue;
      const double shade = 0.55 + 0.45 * sample(grid, shades, x, y, 1);
      pixels[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)] =
          pixel_of(scaled(colour_of(found.difference.at(column, row), limits), shade));
    }
  canvas.image(static_cast<int>(view.box.x), static_cast<int>(view.box.y), width, height, pixels);
}

void draw_outline(Canvas& canvas, const View& view, const RunMaps& maps, double threshold, const Pen& pen) {
  for (const Polyline& line : isolines(maps.grid, maps.deposit_thickness, threshold, AtEdge::close)) {
    const Pixels points = on_canvas(view, line);
    if (pen.dashes.empty()) canvas.line(points, {{1, 1, 1}, pen.width + 2.5, {}, 0.8});  // dashes lie on the other line
    canvas.line(points, pen);
  }
}

/// Those of the second run that the first has as well are drawn once.
std::vector<MapPlace> places_of_both(const Run& first, const Run& second) {
  std::vector<MapPlace> places = first.summary.places;
  for (const MapPlace& place : second.summary.places)
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  return places;
}

constexpr double width = 440, height = 196, left = 62, right = 10, top = 10, bottom = 34;  // of a chart [px]
constexpr std::size_t most_points = 600;                                                   // of a curve

/// What a chart shows: the column's name in the history, and the words above it.
struct Chart {
  std::string column, title, unit;
};

/// What an axis counts in: "GJ" and 1e9, so that its numbers stay short.
struct Scale {
  double factor = 1;
  std::string unit;
};

Scale scale_of(double largest, const std::string& unit) {
  const bool takes_prefix = unit == "J" || unit == "W" || unit.starts_with("N");
  for (const auto& [factor, prefix, words] :
       {std::tuple{1e9, "G", "billion "}, {1e6, "M", "million "}, {1e3, "k", "thousand "}})
    if (largest >= 10 * factor && (takes_prefix || unit == "m\u00b3"))
      return {factor, (takes_prefix ? prefix : words) + unit};
  return {1, unit};
}

/// "m s-1" -> "m/s"
std::string unit_words(const std::string& unit) {
  if (unit == "m s-1") return "m/s";
  if (unit == "m3") return "m\u00b3";
  return unit;
}

std::vector<Chart> charts_of(const ComparedRun& first, const ComparedRun& second) {
  std::vector<Chart> charts{{"kinetic_J", "Kinetic energy", "J"},
                            {"speed_max_m_s", "Largest speed of any point", "m/s"},
                            {"moving_volume_m3", "Volume in motion", "m\u00b3"},
                            {"moving_speed_m_s", "Mean speed of what moves", "m/s"}};
  for (const ComparedRun* run : {&first, &second})
    for (const HistoryColumn& column : run->run.history.columns) {
      const bool known =
          std::any_of(charts.begin(), charts.end(), [&](const Chart& c) { return c.column == column.name; });
      if (column.place.empty() || known) continue;
      charts.push_back({column.name, column.place + ": " + column.quantity, unit_words(column.unit)});
    }
  return charts;
}

/// The span of an axis.
struct Span {
  double low = 0, high = 0;
  void take(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// A column over time as the points of a polyline; every n-th of very many records, and the last.
std::string points_of(const RunHistory& history, const std::string& name, const Span& time, const Span& value) {
  const HistoryColumn *times = history.find("time_s"), *column = history.find(name);
  std::string points;
  const std::size_t stride = column->values.size() / most_points + 1;
  for (std::size_t i = 0; i < column->values.size(); ++i) {
    if ((i % stride != 0 && i + 1 != column->values.size()) || !std::isfinite(column->values[i])) continue;
    const double x = left + (width - left - right) * (times->values[i] - time.low) / (time.high - time.low);
    const double y =
        height - bottom - (height - top - bottom) * (column->values[i] - value.low) / (value.high - value.low);
    points += fmt::format("{:.1f},{:.1f} ", x, y);
  }
  return points;
}

bool holds(const ComparedRun& run, const std::string& name) {
  const HistoryColumn *time = run.run.history.find("time_s"), *column = run.run.history.find(name);
  return time != nullptr && column != nullptr && time->values.size() > 1 &&
         column->values.size() == time->values.size();
}

std::vector<double> ticks(double first, double last, double step) {
  std::vector<double> all;
  const double steps = std::floor((last - first) / step + 1e-9);
  for (int n = 0; n <= steps; ++n) all.push_back(first + n * step);
  return all;
}

std::string axes(const Span& time, const Span& value, double factor) {
  std::string text;
  const double across = width - left - right, up = height - top - bottom;
  const double step = factor * axis_step((value.high - value.low) / factor);
  for (const double v : ticks(std::ceil(value.low / step) * step, value.high, step)) {
    const double y = height - bottom - up * (v - value.low) / (value.high - value.low);
    text += fmt::format(
        "<path d=\"M{:.1f} {:.1f}h{:.1f}\" class=\"g\"/><text x=\"{:.1f}\" y=\"{:.1f}\" class=\"e\">{:g}</text>", left,
        y, across, left - 5, y + 4, std::abs(v) < 1e-9 * step ? 0 : v / factor);
  }
  const double every = axis_step(time.high - time.low);
  for (const double t : ticks(time.low, time.high, every))
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"m\">{:g}</text>",
                        left + across * (t - time.low) / (time.high - time.low), height - bottom + 14, t);
  return text +
         fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"m\">time [s]</text>", left + across / 2, height - 4);
}

std::string chart(const Chart& asked, const ComparedRun& first, const ComparedRun& second) {
  Span time, value;
  for (const ComparedRun* run : {&first, &second}) {
    if (!holds(*run, asked.column)) continue;
    for (const double t : run->run.history.find("time_s")->values) time.take(t);
    for (const double v : run->run.history.find(asked.column)->values) value.take(v);
  }
  if (!(time.high > time.low) || !(value.high > value.low)) return "";  // nothing ever happened there
  const Scale scale = scale_of(std::max(value.high, -value.low), asked.unit);
  std::string text = fmt::format("<figure><figcaption>{}</figcaption><svg viewBox=\"0 0 {:g} {:g}\" role=\"img\">",
                                 escaped_xml(fmt::format("{} [{}]", asked.title, scale.unit)), width, height);
  text += axes(time, value, scale.factor);
  for (const auto& [run, line] : {std::pair{&first, "a"}, {&second, "b"}})
    if (holds(*run, asked.column))
      text += fmt::format("<polyline class=\"{}\" points=\"{}\"/>", line,
                          points_of(run->run.history, asked.column, time, value));
  return text + "</svg></figure>\n";
}

}  // namespace

std::vector<double> difference_limits(const DepositDifference& found) {
  const double most = std::max(found.larger, found.smaller);
  if (!(most > 1e-6)) return {};  // the deposits are the same
  const double least = round_below(most / 50);
  std::vector<double> limits;
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0})
    if (least * factor < most) limits.push_back(least * factor);
  return limits;
}

std::string difference_map(const Run& first_run, const Run& second_run, const DepositDifference& found,
                           double threshold) {
  const RunMaps &first = first_run.maps, &second = second_run.maps;
  const Window window = window_of(first, second, threshold);
  const double scale = std::min(1400 / window.width(), 1000 / window.height());
  const View view{window, {0, 0, std::round(window.width() * scale), std::round(window.height() * scale)}};
  Canvas canvas(static_cast<int>(view.box.width), static_cast<int>(view.box.height));
  draw_difference(canvas, view, first, found);
  draw_contours(canvas, view, first, contour_levels(view, first));
  draw_outline(canvas, view, first, threshold, {{0.1, 0.1, 0.12}, 3, {}, 1});
  draw_outline(canvas, view, second, threshold, {{0.0, 0.45, 0.36}, 3, {14, 8}, 1});
  draw_places(canvas, view, places_of_both(first_run, second_run));
  canvas.frame(view.box, {{0.1, 0.1, 0.12}, 2.5, {}, 1});
  return canvas.png();
}

double axis_step(double range) { return round_below(range / 4); }

std::string history_charts(const ComparedRun& first, const ComparedRun& second) {
  std::string charts;
  for (const Chart& asked : charts_of(first, second)) charts += chart(asked, first, second);
  if (charts.empty()) return "";
  return fmt::format(
      "<h2>Over time</h2>\n<p class=\"keys\"><svg viewBox=\"0 0 40 10\" class=\"key\"><path class=\"a\" "
      "d=\"M0 5h40\"/></svg> {} <svg viewBox=\"0 0 40 10\" class=\"key\"><path class=\"b\" d=\"M0 "
      "5h40\"/></svg> {}</p>\n<div class=\"charts\">{}</div>\n",
      escaped_xml(first.name), escaped_xml(second.name), charts);
}

}  // namespace talus::postprocess
