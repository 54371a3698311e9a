// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/fields/fields.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "common/map/raster.hpp"
#include "common/table_words.hpp"

namespace talus::postprocess {
namespace {

/// A map by its name in the table map_fields. Throws std::logic_error for a name that is not in it.
const MapField& map_field(std::string_view name) {
  for (const MapField& field : map_fields)
    if (name == field.name) return field;
  throw std::logic_error("there is no map " + std::string(name));
}

/// Lower limits of classes that fit values up to `largest`: those of `ladder` (the thresholds of a field's usual maps,
/// rising) that are exceeded, of which the lowest `kept` and the highest ones make `most` at most; with finer ones (1,
/// 2, 5 times a power of ten) below where they would be fewer than four. `largest` not above 0: the first four.
std::vector<double> fitting_limits(const std::vector<double>& ladder, double largest, std::size_t kept,
                                   std::size_t most = 6) {
  constexpr std::size_t fewest = 4;
  if (!(largest > 0))
    return {ladder.begin(), ladder.begin() + static_cast<std::ptrdiff_t>(std::min(fewest, ladder.size()))};
  std::vector<double> limits;
  for (const double limit : ladder)
    if (limit < largest) limits.push_back(limit);
  if (limits.size() > most) {
    const auto from = limits.begin() + static_cast<std::ptrdiff_t>(kept);
    limits.erase(from, from + static_cast<std::ptrdiff_t>(limits.size() - most));
  }
  while (limits.size() < fewest)
    limits.insert(limits.begin(), round_below((1 - 1e-9) * (limits.empty() ? largest : limits.front())));
  return limits;
}

std::optional<double> fact(const RunSummary& summary, std::string_view name) {
  for (const auto& [key, value] : summary.provenance) {
    double number = 0;
    if (key != name) continue;
    if (std::from_chars(value.data(), value.data() + value.size(), number).ec == std::errc()) return number;
  }
  return std::nullopt;
}

/// Grows a window around the cells of a map that reach their threshold.
template <class Threshold>
void grow(Window& window, const MapGrid& grid, const std::vector<double>& values, const Threshold& threshold) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] >= threshold(i))) continue;
    const auto [column, row] = grid.cell_of(i);
    const double x = grid.west + column * grid.cell, y = grid.south + row * grid.cell;
    window = {std::min(window.west, x), std::min(window.south, y), std::max(window.east, x + grid.cell),
              std::max(window.north, y + grid.cell)};
  }
}

/// The thinnest that a map colours, outlines or takes for moved [m].
double thinnest_shown(const RunMaps& maps, const Options& options) {
  double least = std::min(options.footprint_threshold, options.deposit_threshold);
  if (maps.threshold > 0) least = std::min(least, maps.threshold);
  for (const auto* values : {&maps.peak_thickness, &maps.deposit_thickness})
    least = std::min(least, thickness_limits(options.classes, *values).front());
  return least;
}

/// Widen one side of [low, high] pair to `length`, keeping inside [least, most].
void widen(double& low, double& high, double length, double least, double most) {
  const double room = std::min(length, most - least), middle = 0.5 * (low + high);
  low = std::clamp(middle - 0.5 * room, least, most - room);
  high = low + room;
}

}  // namespace

std::vector<MapField> product_fields(const RunMaps& maps) {
  std::vector<MapField> products;
  for (const MapField& field : map_fields)
    if (!std::string_view(field.product.legend).empty() && !(maps.*(field.values)).empty()) products.push_back(field);
  return products;
}

std::vector<char> inside_domain(const RunMaps& maps) {
  std::vector<char> inside(maps.grid.count());
  for (std::size_t i = 0; i < inside.size(); ++i)
    inside[i] = std::isfinite(maps.terrain[i]) || maps.deposit_thickness[i] > 0 || maps.peak_thickness[i] > 0;
  return inside;
}

Raster field_raster(const RunMaps& maps, const MapField& field) {
  return values_raster(maps, maps.*(field.values), field.product.zero_inside);
}

Raster values_raster(const RunMaps& maps, const std::vector<double>& values, bool zero_inside) {
  Raster raster{maps.grid, values};
  const auto inside = inside_domain(maps);
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (!inside[i])
      raster.values[i] = nan;
    else if (zero_inside && std::isnan(raster.values[i]))
      raster.values[i] = 0;
  return raster;
}

std::vector<std::string> file_words(const std::vector<std::pair<std::string, std::vector<double>>>& named) {
  std::vector<std::string> words;
  const auto taken = [&](const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  for (const auto& [name, values] : named) {
    const std::string plain = file_word(name);
    std::string word = plain;
    for (int k = 2; taken(word); ++k) word = fmt::format("{}-{}", plain, k);
    words.push_back(word);
  }
  return words;
}

std::string file_word(const std::string& name) {
  std::string word = name;
  for (char& c : word) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
    if (!plain) c = '-';
  }
  return word;
}

std::string csv_field(std::string text) {
  constexpr std::string_view begins_a_formula = "=+-@\t\r";
  const bool formula = !text.empty() && begins_a_formula.find(text.front()) != std::string_view::npos;
  if (formula && !signed_number(text)) text.insert(text.begin(), '\'');
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

double volume_under(const std::vector<double>& thickness, double cell) {
  long double sum = 0;
  for (const double h : thickness)
    if (std::isfinite(h)) sum += h;
  return static_cast<double>(sum * static_cast<long double>(cell) * static_cast<long double>(cell));
}

ReleaseNumbers numbers_of(const Raster& thickness, const std::vector<double>& cosine, double limit) {
  const double area = thickness.grid.cell * thickness.grid.cell;
  ReleaseNumbers numbers;
  for (std::size_t i = 0; i < cosine.size(); ++i) {
    const double h = thickness.values[i];
    if (!(h > 0)) continue;
    numbers.volume_if_normal += h * area / cosine[i];
    numbers.thickest = std::max(numbers.thickest, h);
    numbers.thickest_normal = std::max(numbers.thickest_normal, h * cosine[i]);
    if (!(h > limit)) continue;
    numbers.area += area;
    numbers.true_area += area / cosine[i];
  }
  return numbers;
}

ReleaseNumbers release_numbers(const Run& run, double limit) {
  const RunSummary& s = run.summary;
  const auto if_normal = fact(s, "volume_if_thickness_were_slope_normal_m3"),
             area = fact(s, "released_area_projected_m2"), true_area = fact(s, "released_area_true_m2"),
             thickest = fact(s, "max_thickness_vertical_m"), normal = fact(s, "max_thickness_slope_normal_m");
  const MapGrid& grid = run.maps.grid;
  if (!if_normal || !area || !true_area || !thickest || !normal)
    return numbers_of({grid, run.maps.initial_thickness}, slope_cosine({grid, run.maps.terrain}), limit);
  return {*if_normal, *area, *true_area, *thickest, *normal};
}

std::vector<double> class_limits(const std::vector<double>& given, double thickest) {
  if (!given.empty()) return given;
  return fitting_limits({0.1, 0.5, 1, 2, 5, 10, 25, 50, 100, 200, 500}, thickest, 1);
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values)
    if (v > most) most = v;  // NaN is not
  return most;
}

int class_of(double value, const std::vector<double>& limits) {
  if (std::isnan(value)) return -1;
  return static_cast<int>(std::upper_bound(limits.begin(), limits.end(), value) - limits.begin()) - 1;
}

double round_below(double limit) {
  const double power = std::pow(10, std::floor(std::log10(limit)));
  for (const double step : {5.0, 2.0, 1.0})
    if (step * power <= limit * (1 + 1e-12)) return step * power;
  return power;
}

int threshold_decimals(double threshold) {
  return threshold > 0 ? std::max(2, 1 - static_cast<int>(std::floor(std::log10(threshold)))) : 2;
}

std::vector<double> pressure_limits(const std::vector<double>& values) {
  return fitting_limits({1, 3, 5, 10, 100, 1000, 10000}, largest(values), 4, 7);
}

std::vector<double> speed_limits(const std::vector<double>& values) {
  return fitting_limits({0.5, 1, 5, 10, 25, 50, 100}, largest(values), 1);
}

std::vector<double> thickness_limits(const std::vector<double>& given, const std::vector<double>& values) {
  return class_limits(given, largest(values));
}

std::vector<double> time_limits(const std::vector<double>& values) {
  const double last = largest(values);
  if (!(last > 0)) return {1};
  double step = round_below(last / 3);
  if (last / step > 7) step *= 2;
  std::vector<double> limits;
  for (int i = 1; i <= 6 && i * step < last; ++i) limits.push_back(i * step);
  return limits;
}

std::vector<double> map_limits(const MapField& field, const RunMaps& maps, const std::vector<double>& given_classes) {
  const std::vector<double>& values = maps.*(field.values);
  switch (field.product.classes) {
    case MapClasses::pressure: return pressure_limits(values);
    case MapClasses::speed: return speed_limits(values);
    case MapClasses::time: return time_limits(values);
    case MapClasses::share: return {0.1, 0.25, 0.5, 0.75, 1};
    case MapClasses::thickness: break;
  }
  return thickness_limits(given_classes, values);
}

RasterStyle map_style(const std::string& name, const RunMaps& maps, const std::vector<double>& given_classes) {
  if (name.starts_with("difference")) return difference_style(thickness_limits({}, maps.deposit_thickness), "m");
  const bool of_a_release = name.starts_with("deposit_thickness");
  const MapField& field = map_field(of_a_release ? std::string_view("deposit_thickness") : name);
  const std::vector<double> limits = map_limits(field, maps, given_classes);
  switch (field.product.classes) {
    case MapClasses::pressure: return class_style(limits, "kPa");
    case MapClasses::speed: return class_style(limits, "m/s", Ramp::sea);
    case MapClasses::time: return time_style(limits, "s");
    case MapClasses::share: return class_style(limits, "", Ramp::sea);
    case MapClasses::thickness: break;
  }
  return class_style(limits, "m");
}

Window affected_window(const RunMaps& maps, const Options& options, const std::optional<Survey>& survey) {
  const auto& grid = maps.grid;
  constexpr double far = std::numeric_limits<double>::infinity();
  Window w{far, far, -far, -far};
  const double thinnest = thinnest_shown(maps, options);
  const auto shown = [&](std::size_t) { return thinnest; };
  for (const auto* values : {&maps.peak_thickness, &maps.deposit_thickness, &maps.initial_thickness})
    grow(w, grid, *values, shown);
  if (survey) {
    const bool measured = !survey->measured.empty();
    const auto sure = [&](double least) {
      return [&, least](std::size_t i) { return measured ? std::max(least, survey->error.sure(i)) : least; };
    };
    grow(w, survey->grid, survey->deposit, sure(options.deposit_threshold));
    if (survey->footprint_is_change)
      grow(w, survey->grid, survey->footprint, sure(survey->footprint_threshold));
    else
      grow(w, survey->grid, survey->footprint, [&](std::size_t) { return survey->footprint_threshold; });
  }
  if (w.west > w.east) return {grid.west, grid.south, grid.east(), grid.north()};
  const double margin = std::max(0.08 * std::max(w.width(), w.height()), 4 * grid.cell);
  w = {std::max(w.west - margin, grid.west), std::max(w.south - margin, grid.south),
       std::min(w.east + margin, grid.east()), std::min(w.north + margin, grid.north())};
  if (!(w.width() > 0 && w.height() > 0)) return {grid.west, grid.south, grid.east(), grid.north()};
  constexpr double slender = 5.0 / 8;
  widen(w.west, w.east, std::max(w.width(), slender * w.height()), grid.west, grid.east());
  widen(w.south, w.north, std::max(w.height(), slender * w.width()), grid.south, grid.north());
  return w;
}

Window page_window(const RunMaps& maps, const Options& options, const std::optional<Survey>& survey) {
  const auto& grid = maps.grid;
  Window window = affected_window(maps, options, survey);
  const double width = std::min(std::max(window.width(), window.height()), grid.east() - grid.west);
  window.west = std::clamp(0.5 * (window.west + window.east - width), grid.west, grid.east() - width);
  window.east = window.west + width;
  return window;
}

RunMaps cropped(const RunMaps& maps, const Window& window) {
  const auto& grid = maps.grid;
  const auto cell_of = [&](double metres, int count) {
    return std::clamp(static_cast<int>(std::floor(metres / grid.cell)), 0, count - 1);
  };
  const int first = cell_of(window.west - grid.west - 2 * grid.cell, grid.columns),
            last = cell_of(window.east - grid.west + 2 * grid.cell, grid.columns);
  const int bottom = cell_of(window.south - grid.south - 2 * grid.cell, grid.rows),
            top = cell_of(window.north - grid.south + 2 * grid.cell, grid.rows);
  const CellWindow cells{first, bottom, last - first + 1, top - bottom + 1};
  RunMaps part;
  part.grid = cut(grid, cells);
  for (const auto field :
       {&RunMaps::before, &RunMaps::initial_thickness, &RunMaps::deposit_thickness, &RunMaps::peak_thickness})
    part.*field = cut(Raster{grid, maps.*field}, cells).values;
  return part;
}

}  // namespace talus::postprocess
