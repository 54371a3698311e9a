// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/change.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include <fmt/format.h>

#include "common/map/raster.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/regions/way_down.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

/// A slide that grows by regions.
class Growth {
 public:
  Growth(const Raster& before, const Raster& source, const DepositOptions& how)
      : before_(before), how_(how), way_(before), cosine_(slope_cosine(before)) {
    slide_.resize(source.values.size());
    reached_.resize(slide_.size());
    std::vector<std::size_t> cells;
    Sum depth;
    for (std::size_t c = 0; c < slide_.size(); ++c) {
      if (!(source.values[c] > 0)) continue;
      if (cells.empty() || before.values[c] > before.values[crown_]) crown_ = c;
      cells.push_back(c);
      depth.add(source.values[c]);
    }
    allowance_ = cells.empty() ? 0 : depth.value() / static_cast<double>(cells.size());
    take(cells);
  }

  void take(const std::vector<std::size_t>& cells) {
    for (const std::size_t c : cells) slide_[c] = reached_[c] = 1;
    for (const std::size_t c : cells) follow(c);
  }

  bool reaches(const Region& region) const {
    return std::ranges::any_of(region.cells, [&](std::size_t c) { return is_near(c); });
  }

  const std::vector<char>& slide() const { return slide_; }

 private:
  /// Marks the way down from a cell as far as its gap is allowed to be long.
  void follow(std::size_t from) {
    const MapGrid& grid = before_.grid;
    const double bridge = how_.bridge_cells,
                 longest = std::max(bridge, how_.longest_gap * cells_between(grid, crown_, from)),
                 resting = std::cos(how_.steepest_rest * std::numbers::pi / 180);
    double gap = 0;
    std::size_t here = from;
    for (std::vector<std::size_t> way = way_.next(here); !way.empty(); way = way_.next(here)) {
      for (const std::size_t next : way) {
        if (slide_[next]) return;
        if (cosine_[next] >= resting) gap += cells_between(grid, here, next);
        if (gap > longest) return;
        const auto [known, added] = left_.try_emplace(next, longest - gap);
        if (!added && known->second >= longest - gap) return;  // another way went on from here, and further
        known->second = longest - gap;
        reached_[next] = 1;
        here = next;
      }
    }
  }

  bool is_near(std::size_t cell) const {
    const MapGrid& grid = before_.grid;
    const std::array<int, 2> here = grid.cell_of(cell);
    bool found = false;
    each_near(grid, here, how_.bridge_cells, [&](int c, int r) {
      found = found || (reached_[grid.index(c, r)] && !is_barred(here, {c, r}));
    });
    return found;
  }

  /// True where ground between two cells stands above both by more than a flow is thick.
  bool is_barred(std::array<int, 2> a, std::array<int, 2> b) const {
    const double highest = std::max(before_.at(a[0], a[1]), before_.at(b[0], b[1])) + allowance_;
    const int steps = std::max(std::abs(b[0] - a[0]), std::abs(b[1] - a[1]));
    for (int s = 1; s < steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      const int column = static_cast<int>(std::lround(a[0] + t * (b[0] - a[0]))),
                row = static_cast<int>(std::lround(a[1] + t * (b[1] - a[1])));
      if (before_.at(column, row) > highest) return true;  // false for NaN
    }
    return false;
  }

  const Raster& before_;
  const DepositOptions& how_;
  WayDown way_;
  std::vector<double> cosine_;
  std::vector<char> slide_, reached_;             // of the slide; of it or of a way down from it
  std::unordered_map<std::size_t, double> left_;  // how much longer the gap may grow on from a way's cell [cells]
  std::size_t crown_ = 0;                         // highest cell of the source
  double allowance_ = 0;                          // [m]
};

double signed_sum(const Change& change, const std::vector<std::size_t>& cells, const std::vector<char>& inside,
                  double sign) {
  Sum sum;
  for (const std::size_t c : cells)
    if (!inside[c]) sum.add(std::max(0.0, sign * change.rise.values[c]));
  return sum.value() * change.rise.grid.cell * change.rise.grid.cell;
}

constexpr double tells = 0.1;  // of what fell: less that rose has no say in where mass went

}  // namespace

bool Change::believed(std::size_t cell) const { return std::abs(rise.values[cell]) > levels[cell]; }

bool Change::stands_out(std::size_t cell, double factor) const {
  return believed(cell) && std::abs(rise.values[cell]) > factor * noise[cell];
}

std::vector<Region> sure_regions(const Change& change, const DepositOptions& how) {
  const MapGrid& grid = change.rise.grid;
  Raster marked{grid, std::vector<double>(grid.count())};
  for (std::size_t i = 0; i < grid.count(); ++i) marked.values[i] = change.believed(i);
  cut_fringe(grid, marked.values);
  for (std::size_t i = 0; i < grid.count(); ++i)
    if (change.stands_out(i, how.sure_levels)) marked.values[i] = 1;
  std::vector<Region> regions = regions_above(marked, 0.5);
  std::erase_if(regions, [&](const Region& region) {
    int sure = 0;
    bool noisy = false;
    for (const std::size_t c : region.cells) {
      sure += change.stands_out(c, how.sure_levels);
      noisy = noisy || change.noise[c] > 0;
    }
    return sure < (noisy ? how.sure_cells : 1);
  });
  return regions;
}

std::vector<char> grown_slide(const Raster& before, const Raster& source, std::vector<Region> regions,
                              const DepositOptions& how) {
  Growth growth(before, source, how);
  for (bool grown = true; grown;) {
    grown = false;
    for (Region& region : regions) {
      if (region.cells.empty() || !growth.reaches(region)) continue;
      growth.take(region.cells);
      region.cells.clear();
      grown = true;
    }
  }
  return growth.slide();
}

Near change_near(const Raster& before, const Raster& source, const Change& change, const std::vector<char>& inside,
                 const DepositOptions& how) {
  const MapGrid& grid = change.rise.grid;
  Growth growth(before, source, how);
  std::vector<std::size_t> slide;
  Raster marked{grid, std::vector<double>(grid.count(), 0.0)};
  for (std::size_t c = 0; c < inside.size(); ++c)
    if (inside[c])
      slide.push_back(c);
    else if (change.believed(c))
      marked.values[c] = 1;
  growth.take(slide);
  Near near;
  for (const Region& region : regions_above(marked, 0.5)) {
    if (!growth.reaches(region)) continue;
    near.rise += signed_sum(change, region.cells, inside, 1);
    near.fall += signed_sum(change, region.cells, inside, -1);
  }
  return near;
}

double ChangeOutside::unbalanced() const { return std::abs(sure_rise - sure_fall); }

ChangeOutside change_outside(const Change& change, const std::vector<Region>& sure, const std::vector<char>& inside) {
  ChangeOutside outside;
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < inside.size(); ++c)
    if (change.believed(c)) all.push_back(c);
  outside.rise = signed_sum(change, all, inside, 1);
  outside.fall = signed_sum(change, all, inside, -1);
  for (const Region& region : sure) {
    const double rise = signed_sum(change, region.cells, inside, 1),
                 fall = signed_sum(change, region.cells, inside, -1);
    outside.sure_rise += rise;
    outside.sure_fall += fall;
    if (rise + fall <= outside.largest) continue;
    outside.largest = rise + fall;
    const auto cell = std::ranges::find_if(region.cells, [&](std::size_t c) { return !inside[c]; });
    outside.place = place_of(change.rise.grid, *cell);
  }
  return outside;
}

void OrderSum::add(double rise, double before) {
  const std::size_t side = rise > 0;
  volume_[side].add(std::abs(rise));
  moment_[side].add(std::abs(rise) * (before + rise / 2));
}

Order OrderSum::order(double cell) const {
  const double area = cell * cell;
  const auto height = [&](std::size_t side) {
    return volume_[side].value() > 0 ? moment_[side].value() / volume_[side].value() : 0;
  };
  return {volume_[1].value() * area, volume_[0].value() * area, height(1), height(0)};
}

Order order_of(const Change& change, const std::vector<Region>& sure, const Raster& before) {
  OrderSum sum;
  for (const Region& region : sure)
    for (const std::size_t c : region.cells) sum.add(change.rise.values[c], before.values[c]);
  return sum.order(before.grid.cell);
}

std::optional<Fault> wrong_order(const Order& o, const SurveyFiles& files) {
  const bool uphill = o.fall > 0 && o.rise > tells * o.fall && o.rise_height > o.fall_height,
             from_nowhere = o.rise > swells * o.fall;
  if (!uphill && !from_nowhere) return std::nullopt;
  const std::string what =
      fmt::format("{}: {} m3 rose above {}, {} m3 fell", files.after, grouped(o.rise), files.before, grouped(o.fall));
  const std::string why =
      uphill ? fmt::format(
                   "what rose lies {:.1f} m higher than what fell (at {:.1f} and {:.1f} m on average), and mass "
                   "goes down",
                   o.rise_height - o.fall_height, o.rise_height, o.fall_height)
             : fmt::format("more than {:g} times as much rose as fell, and mass comes from somewhere", swells);
  return Fault{what, why,
               std::string("Is before_dem the later one? Then swap before_dem and after_dem") +
                   (files.aligned ? "" : ". Is one too high? Then mode = \"apply\" in [preprocess.coregistration]") +
                   ". Was ground built up (a dam, a dump, ice) or grown over? Then all is well"};
}

void judge_order(const Order& order, const SurveyFiles& files) {
  if (const auto wrong = wrong_order(order, files))
    refuse_unless_accepted("swapped-surveys", *wrong, {{"rise", order.rise, "m3"}, {"fall", order.fall, "m3"}});
}

}  // namespace talus::preprocess
