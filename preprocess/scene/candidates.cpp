// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/scene/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/map/statistics.hpp"
#include "common/map/usual_reach.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/regions/way_down.hpp"
#include "preprocess/terrain/height_statistics.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr std::size_t most_measured = 10;
constexpr double rival_share = 0.1;     // of its volume: less is no rival
constexpr double least_returned = 0.5;  // of what fell: with less, most of it went where nobody knows

std::vector<double> at(const std::vector<double>& values, const std::vector<std::size_t>& cells) {
  std::vector<double> some;
  for (const std::size_t c : cells) some.push_back(values[c]);
  return some;
}

bool is_water(const Lowered& l, const Region& region) {
  return is_level(at(l.before.values, region.cells), at(l.after.values, region.cells),
                  median(at(l.change.noise, region.cells)));
}

/// The cells of the slide that a region would be.
std::vector<char> slide_of(const Lowered& l, const Region& region, const std::vector<Region>& sure,
                           const DepositOptions& how) {
  Raster source{l.before.grid, std::vector<double>(l.before.grid.count(), 0.0)};
  for (const std::size_t c : region.cells) source.values[c] = l.lowering.values[c];
  return grown_slide(l.before, source, sure, how);
}

/// Sets drop and length.
void measure_way(const Lowered& l, const Region& region, const std::vector<char>& slide, Candidate& candidate) {
  const MapGrid& grid = l.before.grid;
  const std::size_t crown =
      *std::ranges::max_element(region.cells, {}, [&](std::size_t c) { return l.before.values[c]; });
  for (std::size_t c = 0; c < slide.size(); ++c) {
    if (!slide[c] || !(l.change.rise.values[c] > 0)) continue;
    const double length = cells_between(grid, crown, c) * grid.cell;
    if (length <= candidate.length) continue;
    candidate.length = length;
    candidate.drop = l.before.values[crown] - l.before.values[c];
  }
}

std::string doubt_of(const Candidate& candidate, const Order& order, bool water) {
  if (water) return "level before and after, as water is";
  if (!(order.rise > 0)) return "nothing rose below it";
  if (order.rise < least_returned * order.fall)
    return fmt::format("on its way {} m3 fell and {} m3 rose, less than half", grouped(order.fall),
                       grouped(order.rise));
  if (const auto wrong = wrong_order(order, {})) return wrong->why;
  const double least = usual_reach(candidate.volume).low, tangent = candidate.drop / candidate.length;
  if (!(tangent > least)) return fmt::format("slides of its volume hardly ever have an H/L below {:.2g}", least);
  return "";
}

/// What all candidates are measured against.
struct Surroundings {
  std::vector<Region> sure;
  std::vector<double> cosine;  // of the slope before
  std::vector<char> aside;     // cells of level and of larger regions: what fell there is no part of a smaller one
};

void set_aside(const Region& region, Surroundings& around) {
  for (const std::size_t c : region.cells) around.aside[c] = 1;
  for (Region& sure : around.sure) std::erase_if(sure.cells, [&](std::size_t c) { return around.aside[c] != 0; });
}

Candidate measured(const Lowered& l, const Region& region, const Surroundings& around, const DepositOptions& how) {
  const MapGrid& grid = l.before.grid;
  const std::size_t deepest =
      *std::ranges::max_element(region.cells, {}, [&](std::size_t c) { return l.lowering.values[c]; });
  const auto [column, row] = grid.cell_of(deepest);
  Candidate candidate{.place = {grid.x(column), grid.y(row)}, .volume = region.volume};
  candidate.slope = std::acos(std::min(1.0, median(at(around.cosine, region.cells)))) * 180 / std::numbers::pi;
  const std::vector<char> slide = slide_of(l, region, around.sure, how);
  OrderSum sum;
  for (std::size_t c = 0; c < slide.size(); ++c)
    if (slide[c] && l.change.rise.values[c] != 0) sum.add(l.change.rise.values[c], l.before.values[c]);
  const Order order = sum.order(grid.cell);
  candidate.rise = order.rise;
  measure_way(l, region, slide, candidate);
  candidate.shares = order.fall > 0 && order.rise > swells * order.fall;
  const auto [foot, top] = std::ranges::minmax(at(l.before.values, region.cells));
  candidate.foot = foot;
  candidate.top = top;
  candidate.doubt = doubt_of(candidate, order, is_water(l, region));
  return candidate;
}

bool is_rival(const Candidate& other, const Candidate& chosen) {
  if (other.place == chosen.place || other.volume < rival_share * chosen.volume) return false;
  return other.doubt.empty() || (other.shares && other.top > chosen.foot);
}

std::string list_of(const std::vector<Candidate>& candidates) {
  std::string text;
  for (const Candidate& candidate : candidates) text += "\n  " + words_of(candidate);
  return text;
}

}  // namespace

std::vector<Candidate> candidates_of(const Lowered& l, const std::vector<Region>& regions, const DepositOptions& how) {
  Surroundings around{sure_regions(l.change, how), slope_cosine(l.before), std::vector<char>(l.before.grid.count())};
  std::vector<char> is_sure(l.before.grid.count());
  for (const Region& region : around.sure)
    for (const std::size_t c : region.cells) is_sure[c] = 1;
  std::vector<const Region*> largest;
  for (const Region& region : regions)
    if (largest.size() < most_measured &&
        std::ranges::any_of(region.cells, [&](std::size_t c) { return is_sure[c] != 0; }))
      largest.push_back(&region);
  if (largest.empty()) largest.push_back(&regions.front());
  for (const Region* region : largest)
    if (is_water(l, *region)) set_aside(*region, around);
  std::vector<Candidate> candidates;
  for (const Region* region : largest) {
    candidates.push_back(measured(l, *region, around, how));
    set_aside(*region, around);
  }
  return candidates;
}

std::string words_of(const Candidate& c) {
  std::string words = fmt::format("{} m3 at [{:.1f}, {:.1f}], slope {:.0f} degrees, ", grouped(c.volume), c.place[0],
                                  c.place[1], c.slope);
  if (c.length > 0) words += fmt::format("H/L {:.2f}, {} m3 rose below", c.drop / c.length, grouped(c.rise));
  return words + (c.length > 0 && !c.doubt.empty() ? ": " : "") + c.doubt;
}

std::array<double, 2> place_of_slide(const std::vector<Candidate>& candidates, const SurveyFiles& files) {
  const auto good = std::ranges::find(candidates, "", &Candidate::doubt);
  if (good == candidates.end() ||
      std::ranges::any_of(candidates, [&](const Candidate& other) { return is_rival(other, *good); })) {
    const std::string what =
        good == candidates.end()
            ? fmt::format("{}: nothing that lies below {} is surely a slide, with fall and a deposit of its size:",
                          files.after, files.before)
            : fmt::format("{}: several regions below {} have fall and a deposit:", files.after, files.before);
    refuse_unless_accepted("doubtful-source",
                           {what + list_of(candidates), "",
                            "Name the slide by seed_m = [x, y] or polygon in [preprocess.source], or mask what is none "
                            "by ignore in [preprocess.difference]"});
    settle_findings();
    return candidates.front().place;
  }
  if (good != candidates.begin())
    warn("larger-lowering",
         fmt::format("source: {}. Larger, but not taken:{}. To take one: seed_m = [x, y] in [preprocess.source]",
                     words_of(*good), list_of({candidates.begin(), good})),
         {{"volume", good->volume, "m3"}, {"larger_volume", candidates.front().volume, "m3"}});
  return good->place;
}

}  // namespace talus::preprocess
