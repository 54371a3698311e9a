// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/validation/closed_forms.hpp"

namespace talus::validation {
namespace {

using postprocess::Align;
using postprocess::Box;
using postprocess::Canvas;
using postprocess::Pen;
using postprocess::Pixels;
using postprocess::TextStyle;

// Okabe & Ito 2008: told apart by colour-blind readers.
constexpr std::array<Colour, 8> palette{{{0, 0, 0},
                                         {0.000, 0.447, 0.698},
                                         {0.835, 0.369, 0.000},
                                         {0.000, 0.620, 0.451},
                                         {0.800, 0.475, 0.655},
                                         {0.902, 0.624, 0.000},
                                         {0.337, 0.706, 0.914},
                                         {0.55, 0.55, 0.55}}};
constexpr Colour ink{0.15, 0.15, 0.15}, pale{0.88, 0.88, 0.88};

Colour colour_of(int number) { return palette[static_cast<std::size_t>(number) % palette.size()]; }

/// One axis: values to pixels, ticks.
struct Axis {
  bool log = false;
  double low = 0, high = 1;  // values, or their logarithms
  double from = 0, to = 1;   // pixels
  double part(double value) const { return ((log ? std::log10(value) : value) - low) / (high - low); }
  double pixel(double value) const { return from + part(value) * (to - from); }
  bool holds(double value) const {
    if (log && !(value > 0)) return false;
    const double p = part(value);
    return p >= -1e-9 && p <= 1 + 1e-9;
  }

  std::vector<double> ticks(int wanted) const {
    std::vector<double> result;
    if (log) {
      const bool wide = high - low > 2.2;
      for (int decade = static_cast<int>(std::floor(low)); decade <= high; ++decade) {
        for (const double m : {1.0, 2.0, 5.0}) {
          const double value = m * std::pow(10, decade);
          if ((m == 1 || !wide) && holds(value)) result.push_back(value);
        }
      }
      return result;
    }
    const double raw = (high - low) / wanted, size = std::pow(10, std::floor(std::log10(raw)));
    double step = 10 * size;
    for (const double m : {5.0, 2.0, 1.0})
      if (m * size >= raw * 0.999) step = m * size;
    const long first = std::lround(std::ceil(low / step - 1e-9));
    for (long n = first; static_cast<double>(n) * step <= high + 1e-9 * step; ++n)
      result.push_back(static_cast<double>(n) * step);
    return result;
  }
};

std::string tick_text(const Axis& axis, double value) {
  if (axis.log && (value < 1e-3 || value >= 1e5)) {
    const int decade = static_cast<int>(std::floor(std::log10(value) + 1e-9));
    const double m = value / std::pow(10, decade);
    static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string raised = decade < 0 ? "⁻" : "";
    for (const char c : std::to_string(std::abs(decade))) raised += digits[c - '0'];
    return (m > 1.5 ? fmt::format("{:.0f}·10", m) : std::string("10")) + raised;
  }
  return std::abs(value) < 1e-12 ? "0" : fmt::format("{:.6g}", value);
}

/// What the series span along one axis, with some air.
Axis axis_of(const Chart& chart, bool across) {
  Axis axis;
  axis.log = across ? chart.log_x : chart.log_y;
  const auto& given = across ? chart.x : chart.y;
  double low = 1e300, high = -1e300;
  for (const Series& s : chart.series) {
    for (const double v : across ? s.x : s.y) {
      if (!std::isfinite(v) || (axis.log && !(v > 0))) continue;
      const double value = axis.log ? std::log10(v) : v;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (given) {
    low = axis.log ? std::log10(given->low) : given->low;
    high = axis.log ? std::log10(given->high) : given->high;
  } else {
    if (!(low <= high)) low = 0, high = 1;
    if (high - low < 1e-12) low -= 0.5, high += 0.5;
    if (axis.log && high - low < 1) {  // a decade at least: less looks like a trend where there is none
      const double more = 0.5 * (1 - (high - low));
      low -= more;
      high += more;
    }
    const double air = 0.06 * (high - low);
    low -= air;
    high += air;
  }
  axis.low = low;
  axis.high = high;
  return axis;
}

struct Margins {
  double left, right, top, bottom;
};
Margins margins_of(const Chart& chart) {
  return {130, 35, chart.title.empty() ? 16.0 : 64.0, chart.x_label.empty() ? 48.0 : 92.0};
}

struct Frame {
  Axis x, y;
  Box box;
};

Frame frame_of(const Chart& chart, const Box& area) {
  Frame f;
  f.x = axis_of(chart, true);
  f.y = axis_of(chart, false);
  const Margins m = margins_of(chart);
  f.box = {area.x + m.left, area.y + m.top, area.width - m.left - m.right, area.height - m.top - m.bottom};
  if (chart.equal_scales) {
    const double scale = std::min(f.box.width / (f.x.high - f.x.low), f.box.height / (f.y.high - f.y.low));
    const double width = scale * (f.x.high - f.x.low), height = scale * (f.y.high - f.y.low);
    f.box = {f.box.x, f.box.y, width, height};
  }
  f.x.from = f.box.x;
  f.x.to = f.box.x + f.box.width;
  f.y.from = f.box.y + f.box.height;
  f.y.to = f.box.y;
  return f;
}

void draw_axes(const Chart& chart, const Frame& f, Canvas& canvas) {
  const Box& b = f.box;
  const int across = std::max(3, static_cast<int>(b.width / 150)), up = std::max(3, static_cast<int>(b.height / 90));
  for (const double v : f.x.ticks(across)) {
    const double at = f.x.pixel(v);
    canvas.line({{at, b.y}, {at, b.y + b.height}}, {pale, 1.5, {}, 1});
    canvas.text(tick_text(f.x, v), at, b.y + b.height + 32, {24, false, ink, Align::centre, 0, 0});
  }
  for (const double v : f.y.ticks(up)) {
    const double at = f.y.pixel(v);
    canvas.line({{b.x, at}, {b.x + b.width, at}}, {pale, 1.5, {}, 1});
    canvas.text(tick_text(f.y, v), b.x - 12, at + 9, {24, false, ink, Align::right, 0, 0});
  }
  canvas.frame(b, {ink, 2, {}, 1});
  canvas.text(chart.x_label, b.x + b.width / 2, b.y + b.height + 74, {26, false, ink, Align::centre, 0, 0});
  canvas.text(chart.y_label, b.x - 96, b.y + b.height / 2, {26, false, ink, Align::centre, std::numbers::pi / 2, 0});
  canvas.text(chart.title, b.x, b.y - 20, {30, true, ink, Align::left, 0, 0});
}

/// Circle, square, triangle, diamond by colour number, so that marks alone tell the series apart.
Pixels mark_of(int number, double x, double y, double size) {
  static constexpr int corners_of[] = {16, 16, 4, 3, 4, 6, 5, 16};
  const int corners = corners_of[static_cast<std::size_t>(number) % 8];
  const double turn = number % 8 == 2 ? std::numbers::pi / 4 : std::numbers::pi / 2;
  Pixels mark;
  for (int c = 0; c <= corners; ++c) {
    const double angle = turn + 2 * std::numbers::pi * (c % corners) / corners;
    mark.push_back({x + 1.15 * size * std::cos(angle), y - 1.15 * size * std::sin(angle)});
  }
  return mark;
}

Pen pen_of(const Series& s) {
  return {colour_of(s.colour), s.width, s.dashed ? std::vector<double>{14, 9} : std::vector<double>{}, 1};
}

void draw_series(const Series& s, const Frame& f, Canvas& canvas) {
  const auto usable = [&](std::size_t i) {
    return std::isfinite(s.x[i]) && std::isfinite(s.y[i]) && (!f.x.log || s.x[i] > 0) && (!f.y.log || s.y[i] > 0);
  };
  if (s.line) {
    Pixels run;
    for (std::size_t i = 0; i <= s.x.size(); ++i) {
      if (i < s.x.size() && usable(i)) {
        run.push_back({f.x.pixel(s.x[i]), f.y.pixel(s.y[i])});
        continue;
      }
      if (run.size() > 1) canvas.line(run, pen_of(s));
      run.clear();
    }
  }
  for (std::size_t i = 0; s.marks && i < s.x.size(); ++i) {
    if (!usable(i)) continue;
    canvas.fill(mark_of(s.colour, f.x.pixel(s.x[i]), f.y.pixel(s.y[i]), s.mark_size), colour_of(s.colour));
  }
}

/// How much of the data a box would hide: points along all the lines inside it.
int hidden(const Chart& chart, const Frame& f, const Box& box) {
  int count = 0;
  for (const Series& s : chart.series) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      for (int part = 0; part < 8 && (s.line || part == 0); ++part) {
        const std::size_t j = std::min(i + 1, s.x.size() - 1);
        const double share = part / 8.0;
        const double x = f.x.pixel(s.x[i]) * (1 - share) + f.x.pixel(s.x[j]) * share;
        const double y = f.y.pixel(s.y[i]) * (1 - share) + f.y.pixel(s.y[j]) * share;
        count += x > box.x - 10 && x < box.x + box.width + 10 && y > box.y - 10 && y < box.y + box.height + 10;
      }
    }
  }
  return count;
}

void draw_legend(const Chart& chart, const Frame& f, Canvas& canvas) {
  const TextStyle style{23, false, ink, Align::left, 0, 0};
  constexpr double line = 34, sample = 58;
  double width = 0;
  int entries = 0;
  for (const Series& s : chart.series) {
    if (s.name.empty()) continue;
    ++entries;
    width = std::max(width, canvas.text_width(s.name, style));
  }
  if (entries == 0) return;
  const double w = width + sample + 42, h = entries * line + 16, gap = 14;
  const double left = f.box.x + gap, right = f.box.x + f.box.width - w - gap;
  const double top = f.box.y + gap, low = f.box.y + f.box.height - h - gap;
  Box best{right, top, w, h};
  int least = hidden(chart, f, best);
  for (const double y : {top, low, 0.5 * (top + low)}) {  // the first of those that hide least
    for (const double x : {right, left, 0.5 * (left + right)}) {
      const Box box{x, y, w, h};
      const int count = hidden(chart, f, box);
      if (count < least) least = count, best = box;
    }
  }
  canvas.fill(best, {1, 1, 1});
  canvas.frame(best, {pale, 2, {}, 1});
  double y = best.y + 8 + line / 2;
  for (const Series& s : chart.series) {
    if (s.name.empty()) continue;
    const double x = best.x + 12;
    if (s.line) canvas.line({{x, y}, {x + sample, y}}, pen_of(s));
    if (s.marks) canvas.fill(mark_of(s.colour, x + sample / 2, y, s.mark_size), colour_of(s.colour));
    canvas.text(s.name, x + sample + 14, y + 8, style);
    y += line;
  }
}

void draw(const Chart& chart, Canvas& canvas, const Box& area) {
  const Frame frame = frame_of(chart, area);
  draw_axes(chart, frame, canvas);
  canvas.clip(frame.box);
  for (const Series& s : chart.series) draw_series(s, frame, canvas);
  canvas.unclip();
  draw_legend(chart, frame, canvas);
}

}  // namespace

std::string png_of(const Chart& chart, int width, int height) {
  Canvas canvas(width, height);
  draw(chart, canvas, {0, 0, static_cast<double>(width), static_cast<double>(height)});
  return canvas.png();
}

std::string png_of_panels(const std::vector<Chart>& panels, int width) {
  std::vector<double> heights;
  double total = 0;
  for (const Chart& panel : panels) {
    const Margins m = margins_of(panel);
    const Axis x = axis_of(panel, true), y = axis_of(panel, false);
    heights.push_back(m.top + m.bottom + (width - m.left - m.right) * (y.high - y.low) / (x.high - x.low));
    total += heights.back();
  }
  Canvas canvas(width, static_cast<int>(std::ceil(total)));
  double top = 0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    draw(panels[i], canvas, {0, top, static_cast<double>(width), heights[i]});
    top += heights[i];
  }
  return canvas.png();
}

Chart plain_chart(const std::string& title, const std::string& x_label, const std::string& y_label) {
  Chart chart;
  chart.title = title;
  chart.x_label = x_label;
  chart.y_label = y_label;
  return chart;
}

Chart log_chart(const std::string& title, const std::string& x_label, const std::string& y_label) {
  Chart chart = plain_chart(title, x_label, y_label);
  chart.log_x = chart.log_y = true;
  return chart;
}

Series convergence(const Series& errors) {
  Series s = marked_line(errors.name, errors.colour);
  for (std::size_t i = 0; i < errors.x.size(); ++i)
    if (std::isfinite(errors.y[i]) && errors.y[i] > 0) s.add(errors.x[i], errors.y[i]);
  const auto count = static_cast<int>(s.x.size());
  if (count > 1) s.name = fmt::format("{} (order {:.2f})", errors.name, observed_order(s.x.data(), s.y.data(), count));
  return s;
}

Series slope_line(double order, const Series& errors) {
  const auto [low, high] = std::minmax_element(errors.x.begin(), errors.x.end());
  Series s{fmt::format("order {:g}", order), {*low, *high}, {}, 7};
  for (const double x : s.x) s.y.push_back(errors.y.front() * std::pow(x / errors.x.front(), order));
  s.dashed = true;
  s.width = 2.5;
  return s;
}

}  // namespace talus::validation
