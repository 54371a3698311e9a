#include "preprocess/laboratory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "preprocess/particles/shift.hpp"

namespace talus::preprocess {

namespace {

constexpr double rounding = 1e-6;  // of a cell: what a length written in decimals may be off by

struct Side {
  const char *low_key, *high_key;
  double low, high;  // [m]
  double length() const { return high - low; }
};

std::array<Side, 3> sides_of(const BoxOptions& b) {
  return {{{"west_m", "east_m", b.west_m, b.east_m},
           {"south_m", "north_m", b.south_m, b.north_m},
           {"bottom_m", "top_m", b.bottom_m, b.top_m}}};
}

std::string name_of(const BoxOptions& box, std::size_t item) {
  return box.name.empty() ? fmt::format("box-{}", item + 1) : box.name;
}

double layer_height(const GridOptions& grid) { return grid.layer_height_m > 0 ? grid.layer_height_m : grid.spacing_m; }

/// Distance between points along x, y and height [m].
std::array<double, 3> point_spacing(const GridOptions& grid) {
  const auto& n = grid.points_per_cell;
  return {grid.spacing_m / n.at(0), grid.spacing_m / n.at(1), layer_height(grid) / n.at(2)};
}

/// Points along x, y and height.
std::array<long, 3> lattice_of(const BoxOptions& box, const GridOptions& grid) {
  const auto sides = sides_of(box);
  const auto spacing = point_spacing(grid);
  std::array<long, 3> counts{};
  for (std::size_t a = 0; a < 3; ++a) counts[a] = std::lround(sides[a].length() / spacing[a]);
  return counts;
}

MapGrid grid_of(const Options& options) {
  const LaboratoryOptions& lab = options.laboratory;
  MapGrid grid;
  grid.columns = lab.columns;
  grid.rows = lab.rows;
  grid.west = lab.west_m;
  grid.south = lab.south_m;
  grid.cell = options.grid.spacing_m;
  return grid;
}

/// Part of the cell [low, low + size] that [from, to] covers.
double covered(double low, double size, double from, double to) {
  const double length = std::min(low + size, to) - std::max(low, from);
  return length > rounding * size ? std::min(length / size, 1.0) : 0.0;
}

Raster cover_of(const MapGrid& grid, const BoxOptions& box) {
  Raster cover{grid, std::vector<double>(grid.count(), 0.0)};
  for (int row = 0; row < grid.rows; ++row) {
    const double in_row = covered(grid.south + row * grid.cell, grid.cell, box.south_m, box.north_m);
    for (int column = 0; in_row > 0 && column < grid.columns; ++column) {
      cover.at(column, row) = in_row * covered(grid.west + column * grid.cell, grid.cell, box.west_m, box.east_m);
    }
  }
  return cover;
}

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
    if (g.west_m || g.south_m || g.east_m || g.north_m)
      add("grid.west_m or its like is given with a laboratory", "there is no elevation model to crop",
          "Use laboratory.west_m, south_m, columns and rows");
    if (g.minimum_thickness_m > 0)
      add("grid.minimum_thickness_m is given with a laboratory", "boxes are filled by a regular lattice",
          "Leave it out");
  }

  bool grid() {
    const LaboratoryOptions& lab = o_.laboratory;
    const auto before = faults_.size();
    if (lab.columns < 1 || lab.rows < 1)
      add(fmt::format("laboratory.columns = {}, rows = {}", lab.columns, lab.rows), "both must be positive",
          "Give the number of cells along x and y");
    if (!(o_.grid.spacing_m > 0))
      add("grid.spacing_m is not given", "a laboratory has no elevation model to take it from",
          "Give the width of a cell in metres");
    if (o_.box.empty())
      add("a laboratory without [[preprocess.box]]", "nothing would move", "Give at least one box of material");
    return faults_.size() == before;
  }

  void box(const BoxOptions& b, std::size_t item) {
    if (!names_.insert(name_of(b, item)).second)
      add(fmt::format("box {}: name \"{}\" is taken", item + 1, name_of(b, item)), "results are told apart by name",
          "Name it otherwise");
    const auto sides = sides_of(b);
    const auto spacing = point_spacing(o_.grid);
    for (std::size_t a = 0; a < 3; ++a) {
      if (extends(sides[a], item)) fits(sides[a], spacing[a], item);
    }
    const MapGrid map = grid_of(o_);
    inside(sides[0], map.west, map.east(), item);
    inside(sides[1], map.south, map.north(), item);
  }

  bool extends(const Side& side, std::size_t item) {
    if (side.length() > 0) return true;
    add(fmt::format("box {}: {} = {}, {} = {}", item + 1, side.low_key, side.low, side.high_key, side.high),
        "the box has no extent", fmt::format("{} must be the larger", side.high_key));
    return false;
  }

  void fits(const Side& side, double spacing, std::size_t item) {
    const double points = std::max(std::round(side.length() / spacing), 1.0);
    if (std::abs(side.length() / spacing - points) <= rounding * points) return;
    add(fmt::format("box {}: {} to {} is {:.12g} m", item + 1, side.low_key, side.high_key, side.length()),
        fmt::format("it is no multiple of the points' spacing of {:.12g} m, so that they would not fill it", spacing),
        fmt::format("Take {} = {:.12g} or {:.12g}, or other grid.points_per_cell", side.high_key,
                    side.low + std::max(1.0, std::floor(side.length() / spacing)) * spacing,
                    side.low + std::ceil(side.length() / spacing) * spacing));
  }

  void inside(const Side& side, double low, double high, std::size_t item) {
    const double cell = o_.grid.spacing_m, slack = rounding * cell;
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
          shared =
              shared && std::min(a[s].high, b[s].high) - std::max(a[s].low, b[s].low) > rounding * o_.grid.spacing_m;
        }
        if (shared)
          add(fmt::format("{} and {} overlap", name_of(o_.box[i], i), name_of(o_.box[j], j)),
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

Raster laboratory_ground(const Options& options) {
  const LaboratoryOptions& lab = options.laboratory;
  const MapGrid grid = grid_of(options);
  Raster ground{grid, std::vector<double>(grid.count())};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      ground.at(column, row) =
          lab.ground_m + lab.slope_x * (grid.x(column) - grid.west) + lab.slope_y * (grid.y(row) - grid.south);
    }
  }
  return ground;
}

Release box_release(const Options& options, std::size_t item) {
  const BoxOptions& box = options.box.at(item);
  Raster thickness = cover_of(grid_of(options), box);
  for (double& value : thickness.values) value *= box.top_m - box.bottom_m;
  return {name_of(box, item), std::move(thickness)};
}

Raster box_surface(const Options& options, const Raster& ground) {
  std::vector<double> height(ground.values.size(), 0.0);
  for (const BoxOptions& box : options.box) {
    const Raster cover = cover_of(ground.grid, box);
    for (std::size_t i = 0; i < height.size(); ++i) height[i] = std::max(height[i], cover.values[i] * box.top_m);
  }
  Raster surface = ground;
  for (std::size_t i = 0; i < height.size(); ++i) surface.values[i] += height[i];
  return surface;
}

std::size_t count_box_points(const Options& options) {
  std::size_t count = 0;
  for (const BoxOptions& box : options.box) {
    const auto n = lattice_of(box, options.grid);
    count += static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]);
  }
  return count;
}

SeedPoints seed_boxes(const Options& options) {
  SeedPoints points;
  Shift shift(options.grid.jitter, static_cast<std::uint64_t>(options.grid.jitter_seed));
  for (std::size_t b = 0; b < options.box.size(); ++b) {
    const auto n = lattice_of(options.box[b], options.grid);
    const auto side = sides_of(options.box[b]);
    const auto place = [&](std::size_t axis, long step) {
      return side[axis].low +
             (static_cast<double>(step) + 0.5 + shift()) * side[axis].length() / static_cast<double>(n[axis]);
    };
    const double count = static_cast<double>(n[0]) * static_cast<double>(n[1]) * static_cast<double>(n[2]);
    const double volume = side[0].length() * side[1].length() * side[2].length() / count;
    for (long k = 0; k < n[2]; ++k) {
      for (long j = 0; j < n[1]; ++j) {
        for (long i = 0; i < n[0]; ++i) {
          points.x.push_back(place(0, i));
          points.y.push_back(place(1, j));
          points.height.push_back(place(2, k));
          points.volume.push_back(volume);
          points.extent_x.push_back(side[0].length() / static_cast<double>(n[0]));
          points.extent_y.push_back(side[1].length() / static_cast<double>(n[1]));
          points.release.push_back(static_cast<int>(b));
        }
      }
    }
  }
  return points;
}

}  // namespace talus::preprocess
