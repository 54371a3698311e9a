#include "preprocess/options/laboratory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace talus::preprocess {

namespace {

constexpr double rounding = 1e-6;  // of a cell: what a length written in decimals may be off by

double layer_height(const GridOptions& grid) { return grid.layer_height > 0 ? grid.layer_height : grid.spacing; }

}  // namespace

std::array<BoxSide, 3> sides_of(const BoxOptions& b) {
  return {{{"west_m", "east_m", b.west, b.east},
           {"south_m", "north_m", b.south, b.north},
           {"bottom_m", "top_m", b.bottom, b.top}}};
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

namespace {

class Checker {
 public:
  Checker(const Options& options, std::vector<Fault>& faults) : o_(options), faults_(faults) {}

  void check() {
    other_ways();
    if (!grid()) return;
    for (std::size_t b = 0; b < o_.box.size(); ++b) box(o_.box[b], b);
    if (faults_.empty()) overlaps();
  }

 private:
  void add(std::string what, std::string why, std::string mend) {
    faults_.push_back({"[preprocess]: " + std::move(what), std::move(why), std::move(mend)});
  }

  void other_ways() {
    const std::string mend = "Leave it out, or give elevation models instead of [preprocess.laboratory]";
    for (const auto& [key, path] :
         {std::pair{"before_dem", &o_.before_dem}, std::pair{"after_dem", &o_.after_dem},
          std::pair{"sliding_surface", &o_.sliding_surface}, std::pair{"base_dem", &o_.base_dem},
          std::pair{"source.polygon", &o_.source.polygon}}) {
      if (!path->empty()) add(fmt::format("{} is given with a laboratory", key), "they belong to different ways", mend);
    }
    if (!o_.release.empty())
      add("[[preprocess.release]] is given with a laboratory", "they belong to different ways", mend);
    if (!o_.working_crs.empty())
      add("working_crs is given with a laboratory", "a laboratory lies in local coordinates", "Leave it out");
    const GridOptions& g = o_.grid;
    if (g.west || g.south || g.east || g.north)
      add("grid.west_m or its like is given with a laboratory", "there is no elevation model to crop",
          "Use laboratory.west_m, south_m, columns and rows");
    if (g.minimum_thickness > 0)
      add("grid.minimum_thickness_m is given with a laboratory", "boxes are filled by a regular lattice",
          "Leave it out");
  }

  bool grid() {
    const LaboratoryOptions& lab = o_.laboratory;
    const auto before = faults_.size();
    if (lab.columns < 1 || lab.rows < 1)
      add(fmt::format("laboratory.columns = {}, rows = {}", lab.columns, lab.rows), "both must be positive",
          "Give the number of cells along x and y");
    if (!(o_.grid.spacing > 0))
      add("grid.spacing_m is not given", "a laboratory has no elevation model to take it from",
          "Give the width of a cell in metres");
    if (o_.box.empty())
      add("a laboratory without [[preprocess.box]]", "nothing would move", "Give at least one box of material");
    return faults_.size() == before;
  }

  void box(const BoxOptions& b, std::size_t item) {
    if (!names_.insert(box_name(b, item)).second)
      add(fmt::format("box {}: name \"{}\" is taken", item + 1, box_name(b, item)), "results are told apart by name",
          "Name it otherwise");
    const auto sides = sides_of(b);
    const auto spacing = point_spacing(o_.grid);
    for (std::size_t a = 0; a < 3; ++a) {
      if (extends(sides[a], item)) fits(sides[a], spacing[a], item);
    }
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
        for (std::size_t s = 0; s < 3; ++s) {
          shared = shared && std::min(a[s].high, b[s].high) - std::max(a[s].low, b[s].low) > rounding * o_.grid.spacing;
        }
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

void check_laboratory(const Options& options, std::vector<Fault>& faults) { Checker(options, faults).check(); }

}  // namespace talus::preprocess
