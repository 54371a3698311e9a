// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/laboratory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "preprocess/options/fault.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {
namespace {

constexpr double rounding = 1e-6;  // of a cell: what a length written in decimals may be off by

double layer_height(const GridOptions& grid) { return grid.layer_height > 0 ? grid.layer_height : grid.spacing; }

/// Declares that keys of the other ways are left out.
void need_no_other_way(recipe::Visitor& v, const Options& o) {
  const auto exclude = [&](bool given, const std::string& what, const char* why, const char* mend) {
    need(v, !o.in_laboratory() || !given, what + " is given with a laboratory", why, mend);
  };
  const char* two_ways = "they belong to different ways";
  const char* choose = "Leave it out, or give elevation models instead of [preprocess.laboratory]";
  exclude(!o.before_dem.empty(), "before_dem", two_ways, choose);
  exclude(!o.after_dem.empty(), "after_dem", two_ways, choose);
  exclude(!o.sliding_surface.empty(), "sliding_surface", two_ways, choose);
  exclude(!o.base_dem.empty(), "base_dem", two_ways, choose);
  exclude(!o.source.polygon.empty(), "source.polygon", two_ways, choose);
  exclude(!o.release.empty(), "[[preprocess.release]]", two_ways, choose);
  exclude(!o.working_crs.empty(), "working_crs", "a laboratory lies in local coordinates", "Leave it out");
  exclude(!o.grid.extent.empty(), "grid.extent_m", "there is no elevation model to crop",
          "Use cells and corner_m of the laboratory");
}

/// The faults that boxes have with the grid and with one another.
class BoxChecker {
 public:
  BoxChecker(const Options& options, std::vector<Fault>& faults) : o_(options), faults_(faults) {}

  void check() {
    for (std::size_t b = 0; b < o_.box.size(); ++b) box(o_.box[b], b);
    if (faults_.empty()) overlaps();
  }

 private:
  void add(std::string what, std::string why, std::string mend) {
    faults_.push_back(fault(std::move(what), std::move(why), std::move(mend)));
  }

  void box(const BoxOptions& b, std::size_t item) {
    if (!names_.insert(box_name(b, item)).second)
      add(fmt::format("box {}: name \"{}\" is taken", item + 1, box_name(b, item)), "results are told apart by name",
          "Name it otherwise");
    const auto sides = sides_of(b);
    const auto spacing = point_spacing(o_.grid);
    if (std::min(b.top, b.top_east.value_or(b.top)) < b.bottom && b.top_east)
      add(fmt::format("box {}: top = {}, top_east_m = {}, bottom = {}", item + 1, b.top, *b.top_east, b.bottom),
          "the top falls below the bottom", "Give tops from the bottom on, and end the box where they meet");
    for (std::size_t a = 0; a < 3; ++a)
      if (extends(sides[a], item)) fits(sides[a], spacing[a], item);
    const MapGrid map = laboratory_grid(o_);
    inside(sides[0], map.west, map.east(), item);
    inside(sides[1], map.south, map.north(), item);
  }

  bool extends(const BoxSide& side, std::size_t item) {
    if (side.length() > 0) return true;
    add(fmt::format("box {}: {} = {}, {} = {}", item + 1, side.low_key, side.low, side.high_key, side.high),
        "the box has no extent", fmt::format("{} must be the larger", side.high_key));
    return false;
  }

  void fits(const BoxSide& side, double spacing, std::size_t item) {
    const double points = std::max(std::round(side.length() / spacing), 1.0);
    if (std::abs(side.length() / spacing - points) <= rounding * points) return;
    add(fmt::format("box {}: {} to {} is {:.12g} m", item + 1, side.low_key, side.high_key, side.length()),
        fmt::format("it is no multiple of the points' spacing of {:.12g} m, so that they would not fill it", spacing),
        fmt::format("Take {} = {:.12g} or {:.12g}, or other grid.points_per_cell", side.high_key,
                    side.low + std::max(1.0, std::floor(side.length() / spacing)) * spacing,
                    side.low + std::ceil(side.length() / spacing) * spacing));
  }

  void inside(const BoxSide& side, double low, double high, std::size_t item) {
    const double cell = o_.grid.spacing, slack = rounding * cell;
    if (side.low >= low + cell - slack && side.high <= high - cell + slack) return;
    add(fmt::format("box {}: {} = {}, {} = {}", item + 1, side.low_key, side.low, side.high_key, side.high),
        fmt::format("the grid reaches from {:.12g} to {:.12g} m, and points need an open cell around them", low, high),
        "Add columns or rows, or move the box: a margin of three cells, and room for it to flow into");
  }

  void overlaps() {
    for (std::size_t i = 0; i < o_.box.size(); ++i) {
      for (std::size_t j = i + 1; j < o_.box.size(); ++j) {
        const auto a = sides_of(o_.box[i]), b = sides_of(o_.box[j]);
        bool shared = true;
        for (std::size_t s = 0; s < 3; ++s)
          shared = shared && std::min(a[s].high, b[s].high) - std::max(a[s].low, b[s].low) > rounding * o_.grid.spacing;
        if (shared)
          add(fmt::format("{} and {} overlap", box_name(o_.box[i], i), box_name(o_.box[j], j)),
              "the material there would count twice", "Move one, or cut it into boxes that only touch");
      }
    }
  }

  const Options& o_;
  std::vector<Fault>& faults_;
  std::set<std::string> names_;
};

}  // namespace

void LaboratoryOptions::describe(recipe::Visitor& v, const Options& all) {
  const bool ignored = !all.in_laboratory();
  const std::string place = "[preprocess.laboratory]";
  recipe::fixed_list<int>(v, "cells", {&columns, &rows}, recipe::not_negative,
                          "from west to east, from south to north; [0, 0] = no laboratory", place);
  need_no_other_way(v, all);
  need(v, ignored || has_cells(), fmt::format("laboratory.cells = [{}, {}]", columns, rows), "both must be positive",
       "Give the number of cells along x and y");
  need(v, ignored || all.grid.spacing > 0, "grid.spacing_m is not given",
       "a laboratory has no elevation model to take it from", "Give the width of a cell in metres");
  need(v, ignored || !all.box.empty() || all.no_release, "a laboratory without [[preprocess.box]]",
       "nothing would move", "Give at least one box of material, or no_release = true with [[solve.inflow]]");
  recipe::fixed_list<double>(v, "corner_m", {&west, &south, &ground}, recipe::any,
                             "south-western corner: easting, northing, elevation of the ground", place);
  recipe::fixed_list<double>(v, "slope", {&slope_x, &slope_y}, recipe::any,
                             "rise of the ground per metre towards the east and the north", place);
}

void BoxOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "name of this box; empty = box-1, box-2, ...");
  recipe::fixed_list<double>(v, "extent_m", {&west, &south, &east, &north, &bottom, &top}, recipe::any,
                             "[west, south, east, north, bottom, top], the last two above the ground; multiples of the "
                             "points' spacing",
                             "[[preprocess.box]]");
  need(v, !(bottom < 0), fmt::format("box: bottom = {} in extent_m", bottom), "it lies below the ground",
       "Give a height above the ground");
  v.optional_number("top_east_m", top_east, recipe::not_negative,
                    "upper side at the eastern end, where it slopes; none = that of extent_m");
}

std::array<BoxSide, 3> sides_of(const BoxOptions& b) {
  return {{{"west", "east", b.west, b.east},
           {"south", "north", b.south, b.north},
           {"bottom", "top", b.bottom, std::max(b.top, b.top_east.value_or(b.top))}}};
}

std::string box_name(const BoxOptions& box, std::size_t item) {
  return box.name.empty() ? fmt::format("box-{}", item + 1) : box.name;
}

std::array<double, 3> point_spacing(const GridOptions& grid) {
  const auto& n = grid.points_per_cell;
  return {grid.spacing / n.at(0), grid.spacing / n.at(1), layer_height(grid) / n.at(2)};
}

MapGrid laboratory_grid(const Options& options) {
  const LaboratoryOptions& lab = options.laboratory;
  MapGrid grid;
  grid.columns = lab.columns;
  grid.rows = lab.rows;
  grid.west = lab.west;
  grid.south = lab.south;
  grid.cell = options.grid.spacing;
  return grid;
}

void check_boxes(const Options& options, std::vector<Fault>& faults) { BoxChecker(options, faults).check(); }

}  // namespace talus::preprocess
