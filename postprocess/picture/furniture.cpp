// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/picture/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/map/statistics.hpp"

namespace talus::postprocess {
namespace {

constexpr Colour ink{0.10, 0.11, 0.13};
constexpr Colour soft_ink{0.38, 0.40, 0.43};

const TextStyle belief_style{.size = 22, .colour = ink};

/// Thousands set apart by thin spaces: 361 200.
std::string grouped(double value) {
  return talus::grouped(fmt::format("{:.0f}", std::abs(value) < 0.5 ? 0.0 : value), "\u2009");
}

/// Draws a text that is shrunk by a fifth at most until it fits; then its end is cut off.
void draw_fitting(Canvas& canvas, std::string words, double x, double y, TextStyle style, double width) {
  const double least = 0.8 * style.size;
  while (style.size > least && canvas.text_width(words, style) > width) style.size -= 0.5;
  if (canvas.text_width(words, style) > width) {
    while (!words.empty() && canvas.text_width(words + "\u2026", style) > width) {
      while (!words.empty() && (static_cast<unsigned char>(words.back()) & 0xC0U) == 0x80U)
        words.pop_back();                    // a whole
      if (!words.empty()) words.pop_back();  // character
    }
    words += "\u2026";
  }
  canvas.text(words, x, y, style);
}

std::string key_numbers(const PictureInput& input) {
  const auto& score = input.score;
  auto words = volume_words(input.run.summary.volume_released) + " released";
  const auto add = [&](const std::string& more) { words += "  \u00b7  " + more; };
  if (const auto runout = score.number("runout_m"))
    add(fmt::format("run-out to > {:g} m: {} m (H/L {:.2f})", input.options.deposit_threshold, grouped(*runout),
                    score.number("h_over_l").value_or(0)));
  const auto deposit = score.number("deposit_csi"), footprint = score.number("footprint_csi"),
             rmse = score.number("thickness_rmse_m");
  if (deposit && footprint)
    add(fmt::format("CSI deposit {:.2f}, footprint {:.2f}", *deposit, *footprint));
  else if (deposit)
    add(fmt::format("CSI deposit {:.2f}", *deposit));
  else if (footprint)
    add(fmt::format("CSI footprint {:.2f}", *footprint));
  if (rmse) add(fmt::format("RMSE {:.1f} m", *rmse));
  return words;
}

/// Writes one thing below the other.
class Column {
 public:
  Column(Canvas& canvas, const Box& box) : canvas_(canvas), box_(box), y_(box.y) {}

  void heading(const std::string& words) {
    y_ += 26;
    draw_fitting(canvas_, words, box_.x, y_, {.size = 26, .bold = true, .colour = ink}, box_.width);
    y_ += 16;
  }
  void swatch(const Colour& colour, const std::string& words) {
    canvas_.fill(Box{box_.x, y_, 64, 36}, colour);
    canvas_.frame({box_.x, y_, 64, 36}, {{0.25, 0.25, 0.27}, 1, {}, 1});
    canvas_.text(words, box_.x + 84, y_ + 27, {.size = 24, .colour = ink});
    y_ += 36;
  }
  void line(const LineStyle& style, const std::string& words) {
    const Pixels sample{{box_.x, y_ + 16}, {box_.x + 64, y_ + 16}};
    if (style.casing.width > 0) canvas_.line(sample, style.casing);
    canvas_.line(sample, style.pen);
    draw_fitting(canvas_, words, box_.x + 84, y_ + 24, {.size = 23, .colour = ink}, box_.width - 84);
    y_ += 38;
  }
  void pair(const std::string& words, const std::string& value) {
    y_ += 31;
    canvas_.text(words, box_.x, y_, {.size = 22, .colour = soft_ink});
    canvas_.text(value, box_.x + box_.width, y_, {.size = 22, .colour = ink, .align = Align::right});
  }
  void space(double height) { y_ += height; }
  double y() const { return y_; }

 private:
  Canvas& canvas_;
  Box box_;
  double y_;
};

void draw_hazard_legend(Column& column, const Hazard& hazard) {
  if (!hazard.buildings.empty()) column.line(building_style, "Buildings");
  if (!hazard.cones.empty())
    column.line(reach_style, fmt::format("Angle of reach, H/L = {:.2f}", hazard.cones.front().tangent));
}

void draw_legend(Column& column, const PictureInput& input, const std::vector<double>& limits, double interval) {
  const bool search = shows_search(input);
  column.heading(search          ? "What fails first, vertical [m]"
                 : input.instant ? "Thickness, vertical [m]"
                                 : "Deposit thickness, vertical [m]");
  for (auto i = limits.size(); i-- > 0;) column.swatch(class_colour(i, limits.size()), class_label(i, limits));
  column.space(22);
  const auto& options = input.options;
  if (input.survey) {
    const auto& survey = *input.survey;
    const bool has_deposit = !survey.deposit.empty();
    if (has_deposit)
      column.line(survey_style, fmt::format("{}: deposit > {:g} m", survey.name, options.deposit_threshold));
    if (!survey.footprint.empty()) {
      const auto limit = fmt::format(" > {:g} m", survey.footprint_threshold);
      const auto what =
          !survey.polygons.empty() ? ": outline" : (survey.footprint_is_change ? ": |change|" : ": peak") + limit;
      column.line(has_deposit ? survey_footprint_style : survey_style, survey.name + what);
    }
  }
  if (!search) column.line(footprint_style, fmt::format("Simulated: peak > {:g} m", options.footprint_threshold));
  column.line(release_style, search ? "Ground that was looked at" : "Release");
  if (input.hazard != nullptr) draw_hazard_legend(column, *input.hazard);
  if (interval > 0) column.line({{{}, 0, {}, 1}, contour_pen(true)}, fmt::format("Contours every {:g} m", interval));
}

void draw_numbers(Column& column, const PictureInput& input) {
  const auto& score = input.score;
  const auto row = [&](const char* key, const char* words, const char* unit, int decimals) {
    const auto value = score.number(key);
    if (!value) return;
    auto text = decimals == 0 ? grouped(*value) : fmt::format("{:.{}f}", *value, decimals);
    const bool zero = text.find_first_of("123456789") == std::string::npos;
    if (text.starts_with('-')) text.replace(0, 1, zero ? "" : "\u2212");
    column.pair(words, text + unit);
  };
  column.heading("Simulation");
  column.pair("Released", volume_words(input.run.summary.volume_released));
  if (input.run.summary.volume_outflow > 0) column.pair("Left the map", volume_words(input.run.summary.volume_outflow));
  if (const auto area = score.number("affected_area_m2")) {
    column.pair(fmt::format("Footprint > {:g}\u2009m", input.options.footprint_threshold),
                *area >= 1e6 ? fmt::format("{:.2f} km\u00b2", *area / 1e6) : fmt::format("{:.1f} ha", *area / 1e4));
  }
  const std::string limit = fmt::format(" > {:g}\u2009m", input.options.deposit_threshold);
  row("runout_m", ("Run-out L" + limit).c_str(), "\u2009m", 0);
  row("drop_m", "Drop H", "\u2009m", 0);
  row("fahrboeschung_deg", "Angle of reach", "\u00b0", 1);
  row("max_deposit_thickness_m", "Thickest deposit", "\u2009m", 1);
  row("max_peak_speed_m_s", "Peak speed", "\u2009m/s", 0);
  column.pair("Time simulated", fmt::format("{:.0f}\u2009s", input.run.summary.time_end));
  if (!input.survey) return;
  column.space(36);
  column.heading("Against " + input.survey->name);
  row("footprint_csi", fmt::format("Footprint CSI > {:g}\u2009m", input.options.footprint_threshold).c_str(), "", 2);
  row("deposit_csi", ("Deposit CSI" + limit).c_str(), "", 2);
  row("thickness_rmse_m", "Thickness RMSE", "\u2009m", 2);
  row("thickness_bias_m", "Thickness bias", "\u2009m", 2);
  row("runout_difference_m", "Run-out difference", "\u2009m", 0);
}

void draw_north_arrow(Canvas& canvas, double x, double y) {
  canvas.fill(Pixels{{x, y}, {x - 17, y + 58}, {x, y + 45}}, ink);
  canvas.fill(Pixels{{x, y}, {x + 17, y + 58}, {x, y + 45}}, {0.72, 0.73, 0.75});
  canvas.line({{x, y}, {x - 17, y + 58}, {x, y + 45}, {x + 17, y + 58}, {x, y}}, {ink, 1.5, {}, 1});
  canvas.text("N", x, y + 86, {.size = 24, .bold = true, .colour = ink, .align = Align::centre});
}

void draw_scale_bar(Canvas& canvas, const View& view, double x, double y, double room) {
  const double length = round_below(room / view.scale()), width = length * view.scale();
  for (int i = 0; i < 4; ++i)
    canvas.fill(Box{x + 0.25 * i * width, y, 0.25 * width, 13}, i % 2 == 0 ? ink : Colour{1, 1, 1});
  canvas.frame({x, y, width, 13}, {ink, 1.5, {}, 1});
  const bool kilometres = length >= 2000;
  const auto words = [&](double metres) { return fmt::format("{:g}", kilometres ? metres / 1000 : metres); };
  const TextStyle style{.size = 21, .colour = ink, .align = Align::centre};
  canvas.text("0", x, y + 38, style);
  canvas.text(words(0.5 * length), x + 0.5 * width, y + 38, style);
  canvas.text(words(length) + (kilometres ? " km" : " m"), x + width, y + 38, style);
}

/// Multiples of a round step inside [low, high], about five.
std::vector<double> ticks(double low, double high, double pixels) {
  const double step = round_below((high - low) * std::max(300 / pixels, 0.14));
  std::vector<double> places;
  const double first = std::ceil(low / step);
  for (int n = 0; (first + n) * step <= high; ++n) places.push_back((first + n) * step);
  return places;
}

/// A number that the search has left in run.h5, as stability.NAME.
std::optional<double> searched(const PictureInput& input, const std::string& name) {
  const auto& facts = input.run.summary.provenance;
  const auto fact = std::ranges::find(facts, "stability." + name, [](const auto& f) { return f.first; });
  if (fact == facts.end()) return {};
  char* end = nullptr;
  const double value = std::strtod(fact->second.c_str(), &end);
  if (end == fact->second.c_str()) return {};
  return value;
}

}  // namespace

std::string volume_words(double volume) {
  if (volume >= 999'500)
    return fmt::format("{:.{}f} million m\u00b3", volume / 1e6, volume < 99.95e6 ? (volume < 9.995e6 ? 2 : 1) : 0);
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(std::max(volume, 1.0))) - 2));
  return grouped(std::round(volume / unit) * unit) + " m\u00b3";
}

void draw_title(Canvas& canvas, const PictureInput& input, double x, double y, double width) {
  const auto& title = input.run.summary.title;
  const auto words = shows_search(input) ? search_line(input) : key_numbers(input);
  draw_fitting(canvas, title, x, y + 48, {.size = 46, .bold = true, .colour = ink}, width);
  draw_fitting(canvas, words, x, y + 100, {.size = 28, .colour = soft_ink}, width);
}

void draw_coordinates(Canvas& canvas, const View& view) {
  const Pen tick{ink, 2, {}, 1};
  TextStyle style{.size = 20, .colour = ink, .align = Align::centre};
  const auto& box = view.box;
  for (const double x : ticks(view.window.west, view.window.east, box.width)) {
    const double px = view.pixel(x, view.window.south)[0], foot = box.y + box.height;
    canvas.line({{px, foot}, {px, foot + 10}}, tick);
    canvas.line({{px, box.y}, {px, box.y - 10}}, tick);
    canvas.text(grouped(x), px, foot + 34, style);
  }
  style.angle = std::numbers::pi / 2;
  for (const double y : ticks(view.window.south, view.window.north, box.height)) {
    const double py = view.pixel(view.window.west, y)[1];
    canvas.line({{box.x, py}, {box.x - 10, py}}, tick);
    canvas.line({{box.x + box.width, py}, {box.x + box.width + 10, py}}, tick);
    // A name that reached beyond the map's corners would lie on that of another edge or on the title.
    const double half = 0.5 * canvas.text_width(grouped(y), style);
    if (py - half >= box.y && py + half <= box.y + box.height) canvas.text(grouped(y), box.x - 20, py, style);
  }
}

void draw_sidebar(Canvas& canvas, const PictureInput& input, const View& view, const std::vector<double>& limits,
                  double interval, const Box& box) {
  Column column(canvas, box);
  draw_legend(column, input, limits, interval);
  column.space(18);
  draw_scale_bar(canvas, view, box.x + 8, column.y() + 30, box.width - 170);
  draw_north_arrow(canvas, box.x + box.width - 40, column.y() - 4);
  column.space(112);
  if (!shows_search(input)) return draw_numbers(column, input);
  column.heading("Strength reduction");
  for (const auto& [words, value] : search_numbers(input)) column.pair(words, value);
}

void draw_time(Canvas& canvas, double time, const View& view) {
  const auto words = fmt::format("t = {:.1f}\u2009s", time);
  const TextStyle style{.size = 34, .bold = true, .colour = ink};
  const Box box{view.box.x + 18, view.box.y + 18, canvas.text_width("t = 0000.0\u2009s", style) + 28, 56};
  canvas.fill(box, {1, 1, 1});
  canvas.frame(box, {ink, 1.5, {}, 1});
  canvas.text(words, box.x + 14, box.y + 40, style);
}

std::vector<std::string> belief_lines(const Score& score, double width) {
  Canvas ruler(1, 1);
  std::vector<std::string> lines;
  for (const std::string& sentence : score.belief) {
    lines.emplace_back();
    std::istringstream words(sentence);
    for (std::string word; words >> word;) {
      const std::string longer = lines.back() + (lines.back().empty() ? "" : " ") + word;
      if (ruler.text_width(longer, belief_style) <= width || lines.back().empty())
        lines.back() = longer;
      else
        lines.push_back(word);
    }
  }
  return lines;
}

void draw_belief(Canvas& canvas, const std::vector<std::string>& lines, double x, double y) {
  for (const std::string& line : lines) canvas.text(line, x, y += belief_line, belief_style);
}

void draw_footer(Canvas& canvas, const PictureInput& input, double x, double y) {
  const auto& s = input.run.summary;
  const auto words = fmt::format(
      "{} [m]  \u00b7  map cell {:g} m  \u00b7  shading and contours: surface before  \u00b7  {} material points  "
      "\u00b7  Talus {}",
      crs_name(input.run.maps.grid.crs_wkt), input.run.maps.grid.cell, grouped(static_cast<double>(s.particles)),
      s.version);
  canvas.text(words, x, y, {.size = 19, .colour = soft_ink});
}

bool shows_search(const PictureInput& input) { return !input.instant && !input.run.maps.critical_thickness.empty(); }

std::string search_line(const PictureInput& input) {
  const auto factor = searched(input, "factor_of_safety"), volume = searched(input, "critical_volume_m3");
  const std::string ground = volume_words(input.run.summary.volume_released);
  if (!factor || !volume) return "no factor of safety found  \u00b7  " + ground + " of ground";
  return fmt::format("factor of safety {:.2f}  \u00b7  {} of {} fail first", *factor, volume_words(*volume), ground);
}

std::vector<std::pair<std::string, std::string>> search_numbers(const PictureInput& input) {
  std::vector<std::pair<std::string, std::string>> rows{{"Ground", volume_words(input.run.summary.volume_released)}};
  const auto row = [&](const char* name, const char* words, const auto& text) {
    if (const auto value = searched(input, name)) rows.emplace_back(words, text(*value));
  };
  const auto factor = [](double f) { return fmt::format("{:.3f}", f); };
  row("factor_of_safety", "Factor of safety", factor);
  row("lower_factor", "Rests at", factor);
  row("upper_factor", "Fails at", factor);
  row("critical_volume_m3", "Fails first", volume_words);
  row("critical_area_m2", "Its area", [](double area) { return fmt::format("{:.2f} ha", area / 1e4); });
  row("critical_depth_m", "Deepest", [](double depth) { return fmt::format("{:.1f}\u2009m", depth); });
  return rows;
}

}  // namespace talus::postprocess
