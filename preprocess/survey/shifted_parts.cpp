// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/shifted_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "common/map/regions.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/terrain/height_statistics.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr double least_noise = 0.01;  // [m] no two surveys agree better
constexpr double far = 4, clear = 6;  // times the noise
constexpr std::size_t least_part = 200;
constexpr double least_share_of_map = 0.01;  // of the map
constexpr int most_levels = 16;
constexpr double of_step = 0.25, half = 0.5, straight_share = 0.5;
constexpr std::size_t least_line = 20;
constexpr double line_share = 0.15;  // of the edge
constexpr int angles = 360;          // of a half turn
constexpr std::size_t least_rim = 10;

/// The median of the 3 x 3 cells around each cell, of which five at least must be there; NaN where the cell is.
std::vector<double> smoothed(const MapGrid& grid, const std::vector<double>& values) {
  std::vector<double> result(values.size(), nan);
  std::array<double, 9> near{};
  each_cell(grid, [&](int column, int row) {
    const std::size_t i = grid.index(column, row);
    if (std::isnan(values[i])) return;
    std::size_t count = 0;
    each_near(grid, {column, row}, 1, [&](int c, int r) {
      if (const double v = values[grid.index(c, r)]; !std::isnan(v)) near.at(count++) = v;
    });
    if (count < 5) return;
    const auto middle = near.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(near.begin(), middle, near.begin() + static_cast<std::ptrdiff_t>(count));
    result[i] = *middle;
  });
  return result;
}

double noise_of(const MapGrid& grid, const std::vector<double>& values) {
  constexpr int apart = 3;  // medians of 3 x 3 cells that share none
  std::vector<double> differences;
  each_cell(grid, [&](int column, int row) {
    const double here = values[grid.index(column, row)];
    for (const auto& [c, r] : {std::array{column + apart, row}, {column, row + apart}})
      if (grid.holds(c, r))
        if (const double d = values[grid.index(c, r)] - here; !std::isnan(d)) differences.push_back(std::abs(d));
  });
  return differences.empty() ? least_noise : std::max(least_noise, 1.4826 * median(differences) / std::numbers::sqrt2);
}

/// Middle of the window of a width that holds most of the values (sorted), and how many it holds.
std::pair<double, std::size_t> densest(const std::vector<double>& sorted, double width) {
  std::pair<double, std::size_t> best{0, 0};
  for (std::size_t first = 0, end = 0; first < sorted.size(); ++first) {
    while (end < sorted.size() && sorted[end] - sorted[first] <= width) ++end;
    if (end - first > best.second) best = {(sorted[first] + sorted[end - 1]) / 2, end - first};
  }
  return best;
}

/// A side of a cell at the edge of a region: column, row, and the step over it [m]; NaN where it is not known, or where
/// the difference goes on rising or falling on one side of the step.
struct Side {
  double column, row, step;
  double along = 0;  ///< its place on a line [cells]
};

/// The edge of a region, and how many sides have nothing beyond.
struct Edge {
  std::vector<Side> sides;
  std::size_t at_rim = 0;
};

/// Reads the edges of regions of a field.
class EdgeReader {
 public:
  EdgeReader(const MapGrid& grid, const std::vector<double>& values, double noise)
      : grid_(grid), values_(values), noise_(noise), own_(values.size()) {}

  Edge edge_of(const std::vector<std::size_t>& cells) {
    own_.assign(own_.size(), 0);
    for (const std::size_t i : cells) own_[i] = 1;
    Edge edge;
    for (const std::size_t i : cells) {
      const auto [column, row] = grid_.cell_of(i);
      for (const auto& [x, y] : {std::array{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (std::isnan(value(column + x, row + y)))
          ++edge.at_rim;
        else if (!is_own(column + x, row + y))
          edge.sides.push_back({column + 0.5 * x, row + 0.5 * y, step({column, row}, {x, y})});
      }
    }
    return edge;
  }

 private:
  double value(int c, int r) const { return grid_.holds(c, r) ? values_[grid_.index(c, r)] : nan; }
  bool is_own(int c, int r) const { return grid_.holds(c, r) && own_[grid_.index(c, r)] != 0; }

  /// From one cell inside to three outside, which medians of 3 x 3 cells blur no longer.
  double step(std::array<int, 2> at, std::array<int, 2> out) const {
    const auto there = [&](int by) { return std::array{at[0] + by * out[0], at[1] + by * out[1]}; };
    const auto height = [&](int by, bool own) {
      const auto [c, r] = there(by);
      return is_own(c, r) == own ? value(c, r) : nan;
    };
    const double inside = std::isnan(height(-1, true)) ? height(0, true) : height(-1, true);
    const double step = inside - height(3, false), slack = of_step * std::abs(step) + 2 * noise_;
    const auto differ = [&](double a, double b) { return std::abs(a - b) > slack; };       // false for NaN
    const bool slopes = (std::isnan(height(-2, true)) && std::isnan(height(-3, true))) ||  // too narrow to tell
                        differ(height(-4, true), inside) || differ(height(-6, true), inside) ||
                        differ(height(6, false), height(3, false));
    return slopes ? nan : step;
  }

  const MapGrid& grid_;
  const std::vector<double>& values_;
  double noise_;
  std::vector<char> own_;
};

/// Sides near one straight line, and its length from rim to rim of the map [cells].
struct Line {
  std::vector<Side> sides;  ///< in their order along it
  double length = 0;
};

/// The length of a line x cosine + y sine = offset on a map [cells], at least 1.
double length_across(const MapGrid& grid, double cosine, double sine, double offset) {
  double from = -INFINITY, to = INFINITY;  // along the line from its point nearest to the first cell
  const auto clip = [&](double start, double direction, double length) {
    if (std::abs(direction) < 1e-9) return;
    const double a = -start / direction, b = (length - start) / direction;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  };
  clip(offset * cosine, -sine, grid.columns);
  clip(offset * sine, cosine, grid.rows);
  return std::max(1.0, to - from);
}

/// Takes out the sides within one cell of the straight line that most of them are near.
Line take_line(const MapGrid& grid, std::vector<Side>& sides) {
  const double reach = std::hypot(grid.columns, grid.rows) + 1;
  std::size_t most = 0;
  double cosine = 1, sine = 0, offset = 0;
  std::vector<std::size_t> counts;
  for (int a = 0; a < angles; ++a) {
    const double angle = std::numbers::pi * a / angles, c = std::cos(angle), s = std::sin(angle);
    counts.assign(static_cast<std::size_t>(2 * reach) + 3, 0);
    for (const Side& side : sides) ++counts[static_cast<std::size_t>(side.column * c + side.row * s + reach)];
    for (std::size_t k = 0; k + 1 < counts.size(); ++k) {
      if (counts[k] + counts[k + 1] <= most) continue;
      most = counts[k] + counts[k + 1];
      cosine = c, sine = s, offset = static_cast<double>(k + 1) - reach;
    }
  }
  const auto beside = std::stable_partition(sides.begin(), sides.end(), [&](const Side& side) {
    return std::abs(side.column * cosine + side.row * sine - offset) > 1;
  });
  Line line{{beside, sides.end()}, length_across(grid, cosine, sine, offset)};
  for (Side& side : line.sides) side.along = side.row * cosine - side.column * sine;
  std::ranges::sort(line.sides, {}, &Side::along);
  sides.erase(beside, sides.end());
  return line;
}

/// The sides of a line with steps on a trend, which runs through the medians of both halves; where it would more than
/// triple the step from end to end, on their median.
std::vector<Side> even_sides(const Line& line, double noise) {
  std::vector<double> steps;
  for (const Side& side : line.sides)
    if (!std::isnan(side.step)) steps.push_back(side.step);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  const double usual = median(steps), rise = 2 * (median({middle, steps.end()}) - median({steps.begin(), middle})),
               trend = std::abs(rise) <= std::abs(usual) ? rise : 0,
               slack = std::max(of_step * std::abs(usual), 2 * noise), count = static_cast<double>(steps.size());
  std::vector<Side> even;
  double k = 0;  // the number of the step
  for (const Side& side : line.sides) {
    if (std::isnan(side.step)) continue;
    if (std::abs(side.step - usual - trend * (k / count - 0.5)) <= slack) even.push_back(side);
    ++k;
  }
  return even;
}

/// The length of a line that sides lie on [cells]: a jagged edge has several at one place. In their order along it.
double length_of(const std::vector<Side>& sides) {
  double length = 0, last = -INFINITY;
  for (const Side& side : sides)
    if (std::floor(side.along) > std::exchange(last, std::floor(side.along))) ++length;
  return length;
}

/// The straight lines of an edge along which the step is the same.
struct EvenLines {
  double of_edge = 0;  ///< share of the edge that they take
  double of_map = 0;   ///< share of one of them in its way from rim to rim
  double step = 0;     ///< its median with its sign, and of its sizes [m]
  double size = 0;
};

EvenLines even_lines(const MapGrid& grid, std::vector<Side> sides, double noise) {
  const double count = static_cast<double>(sides.size());
  const auto least = std::max(least_line, static_cast<std::size_t>(line_share * count));
  std::vector<double> all, sizes;
  EvenLines lines;
  while (sides.size() >= least) {
    const Line line = take_line(grid, sides);
    if (line.sides.size() < least) break;
    const std::vector<Side> even = even_sides(line, noise);
    lines.of_map = std::max(lines.of_map, length_of(even) / line.length);
    for (const Side& side : even) all.push_back(side.step);
  }
  for (const double step : all) sizes.push_back(std::abs(step));
  lines.step = median(all);
  lines.size = median(sizes);
  const auto high = std::ranges::count_if(sizes, [&](double size) { return size >= half * lines.size; });
  lines.of_edge = static_cast<double>(high) / count;
  return lines;
}

/// The difference of two surveys on a patch while it is searched.
class Search {
 public:
  Search(const Patch& patch, const Placement& placement)
      : grid_(patch.before.grid),
        values_(smoothed(grid_, misfit(patch, placement))),
        before_(patch.before.values),
        noise_(noise_of(grid_, values_)),
        edges_(grid_, values_, noise_) {
    for (const double v : values_)
      if (!std::isnan(v)) sorted_.push_back(v);
    std::sort(sorted_.begin(), sorted_.end());
    least_ = std::max(least_part, static_cast<std::size_t>(least_share_of_map * static_cast<double>(sorted_.size())));
  }

  std::vector<ShiftedPart> parts() {
    if (sorted_.size() < 2 * least_part) return {};
    const double beyond = far * noise_;
    level_ = densest(sorted_, beyond).first;
    taken_.assign(values_.size(), 0);
    look([&](double v) { return v > level_ + beyond; });
    look([&](double v) { return v < level_ - beyond; });
    std::vector<double> rest = sorted_, levels{level_};
    for (int k = 1; k < most_levels; ++k) {
      std::erase_if(rest, [&](double v) { return std::abs(v - levels.back()) <= beyond; });
      const auto densest_now = densest(rest, beyond);
      const double next = densest_now.first;
      if (densest_now.second < least_) break;
      levels.push_back(next);
      look([&](double v) { return std::abs(v - next) <= beyond && std::abs(v - level_) > beyond; });
    }
    leave_out_balanced();
    std::ranges::sort(found_, std::ranges::greater(), [](const ShiftedPart& p) { return p.cells.size(); });
    return std::move(found_);
  }

 private:
  template <class Is>
  void look(const Is& is) {
    Raster marked{grid_, std::vector<double>(values_.size(), 0.0)};
    for (std::size_t i = 0; i < values_.size(); ++i) marked.values[i] = !taken_[i] && is(values_[i]);  // false for NaN
    for (Region& region : regions_above(marked, 0.5))
      if (region.cells.size() >= least_) judge(std::move(region.cells));
  }

  void judge(std::vector<std::size_t> cells) {
    const Edge edge = edges_.edge_of(cells);
    if (edge.sides.size() < least_line) return;
    const EvenLines lines = even_lines(grid_, edge.sides, noise_);
    if (!(lines.size >= clear * noise_) || std::max(lines.of_edge, lines.of_map) < straight_share) return;
    for (const std::size_t i : cells) taken_[i] = 1;
    if (!is_water(cells)) found_.push_back({std::move(cells), lines.step, edge.at_rim >= least_rim});
  }

  bool is_water(const std::vector<std::size_t>& cells) const {
    constexpr double detection = 1.96 * 3 / 1.2533;  // of one cell, from medians of nine
    std::vector<double> before, after;
    for (const std::size_t i : cells) {
      before.push_back(before_[i]);
      after.push_back(before_[i] + values_[i]);
    }
    return is_level(before, after, detection * noise_);
  }

  /// Leaves those that the rim does not cut and that balance what changed elsewhere: scars and heaps of even thickness.
  void leave_out_balanced() {
    std::vector<char> cut(values_.size());
    for (const ShiftedPart& part : found_)
      for (const std::size_t i : part.cells) cut[i] = part.at_rim;
    Sum net;
    for (std::size_t i = 0; i < values_.size(); ++i)
      if (const double d = values_[i] - level_; !cut[i] && std::abs(d) > far * noise_) net.add(d);
    std::erase_if(found_, [&](const ShiftedPart& part) {
      Sum own;
      for (const std::size_t i : part.cells) own.add(values_[i] - level_);
      return !part.at_rim && std::abs(net.value()) < std::abs(net.value() - own.value());
    });
  }

  const MapGrid& grid_;
  std::vector<double> values_;
  const std::vector<double>& before_;
  double noise_;
  EdgeReader edges_;
  std::vector<double> sorted_;
  std::size_t least_ = 0;
  double level_ = 0;
  std::vector<char> taken_;
  std::vector<ShiftedPart> found_;
};

}  // namespace

std::vector<ShiftedPart> shifted_parts(const Patch& patch, const Placement& placement) {
  return Search(patch, placement).parts();
}

void judge_shifted_parts(const std::vector<Patch>& patches, const Placement& placement,
                         const std::filesystem::path& after_file) {
  Placement level = placement;
  level.tilt_x = level.tilt_y = 0;
  for (const Patch& patch : patches) {
    std::vector<ShiftedPart> parts = shifted_parts(patch, level);
    if (parts.empty() && placement.given()) parts = shifted_parts(patch, placement);
    if (parts.empty()) continue;
    const ShiftedPart& part = parts.front();
    const MapGrid& grid = patch.before.grid;
    const double area = static_cast<double>(part.cells.size()) * grid.cell * grid.cell;
    refuse_unless_accepted(
        "shifted-part",
        {fmt::format("{}: less the surface before, {} m2 at {} lie {:.2f} m {} than what is around{}",
                     after_file.string(), grouped(area), place_of(grid, part.cells[part.cells.size() / 2]),
                     std::abs(part.step), part.step < 0 ? "lower" : "higher",
                     parts.size() > 1 ? fmt::format(" ({} such parts)", parts.size()) : ""),
         fmt::format(
             "its edge is straight, with one step all along, and its change is even on both sides{}: a tile or a strip "
             "of one survey that does not fit the others, felled or planted forest, or building ground; hardly a slide",
             part.at_rim ? "; the rim of the map cuts it" : "; nothing balances it"),
         "Level the parts onto one another before, cut one part out of both models (gdal_translate -projwin), or mask "
         "what is none by ignore in [preprocess.difference]"},
        {{"step", part.step, "m"}, {"area", area, "m2"}});
    return;
  }
}

}  // namespace talus::preprocess
