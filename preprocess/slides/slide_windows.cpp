// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of a large elevation model a slide gets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <mutex>

#include "common/error.hpp"
#include "common/map/raster.hpp"
#include "common/stage/machine.hpp"
#include "preprocess/slides/slides.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr int rim = 3;             // cells around what a slide can reach: the flow spreads over that many
constexpr int least_reach = 64;    // cells: how far a line of reach is followed at first
constexpr int ground_side = 1000;  // cells of the coarse ground along a side
constexpr std::size_t most_readers = 16;
constexpr double degrees = M_PI / 180;

struct CellBox {
  int west = 0, south = 0, east = 0, north = 0;  // the last ones not included

  CellBox grown(int by, const MapGrid& within) const {
    return {std::max(west - by, 0), std::max(south - by, 0), std::min(east + by, within.columns),
            std::min(north + by, within.rows)};
  }
  CellWindow window() const { return {west, south, east - west, north - south}; }
};

/// The cells of an outline's rectangle; they may lie beyond the grid.
CellBox box_of(const std::vector<MapPolygon>& outline, const MapGrid& grid) {
  double west = INFINITY, south = INFINITY, east = -INFINITY, north = -INFINITY;
  for (const MapPolygon& polygon : outline)
    for (const auto& [x, y] : polygon.rings.front()) {
      west = std::min(west, x);
      east = std::max(east, x);
      south = std::min(south, y);
      north = std::max(north, y);
    }
  const auto cell = [&](double from) { return std::clamp(std::floor(from / grid.cell), -1e9, 1e9); };
  return {static_cast<int>(cell(west - grid.west)), static_cast<int>(cell(south - grid.south)),
          static_cast<int>(cell(east - grid.west)) + 1, static_cast<int>(cell(north - grid.south)) + 1};
}

/// The ground within a box, and what of it lies below a line of reach from the outline's rectangle.
class ReachOnGround {
 public:
  ReachOnGround(const Elevation& model, const MapGrid& grid, const CellBox& start, double tangent)
      : model_(model), grid_(grid), start_(start), tangent_(tangent) {}

  /// The box of all cells that hang together with the outline's and lie below the line; it is followed further and
  /// further, until it ends within the part of the model that was read, or at the model's edge.
  CellBox find() {
    for (int reach = std::max({least_reach, start_.east - start_.west, start_.north - start_.south});; reach *= 2) {
      const CellBox part = start_.grown(reach, grid_);
      const CellBox found = spread(part);
      const bool ends = (found.west > part.west || part.west == 0) && (found.south > part.south || part.south == 0) &&
                        (found.east < part.east || part.east == grid_.columns) &&
                        (found.north < part.north || part.north == grid_.rows);
      if (ends) return found;
    }
  }

 private:
  CellBox spread(const CellBox& part) const;

  const Elevation& model_;
  const MapGrid& grid_;
  CellBox start_;
  double tangent_;
};

CellBox ReachOnGround::spread(const CellBox& part) const {
  const Raster ground = onto_grid(model_, cut(grid_, part.window()));
  const auto height = [&](int column, int row) { return ground.at(column - part.west, row - part.south); };
  std::vector<char> seen(ground.values.size(), 0);
  std::deque<std::array<int, 2>> front;
  double top = -INFINITY;
  for (int row = start_.south; row < start_.north; ++row)
    for (int column = start_.west; column < start_.east; ++column) {
      top = std::fmax(top, height(column, row));
      seen[ground.grid.index(column - part.west, row - part.south)] = 1;
      front.push_back({column, row});
    }
  const auto is_below = [&](int column, int row) {
    const double x = std::max({start_.west - column, column - start_.east + 1, 0}),
                 y = std::max({start_.south - row, row - start_.north + 1, 0});
    return height(column, row) < top - tangent_ * grid_.cell * std::hypot(x, y);  // false for nodata
  };
  CellBox found = start_;
  while (!front.empty()) {
    const auto [column, row] = front.front();
    front.pop_front();
    found = {std::min(found.west, column), std::min(found.south, row), std::max(found.east, column + 1),
             std::max(found.north, row + 1)};
    for (const auto& [across, up] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const int c = column + across, r = row + up;
      if (c < part.west || r < part.south || c >= part.east || r >= part.north) continue;
      char& known = seen[ground.grid.index(c - part.west, r - part.south)];
      if (known || !is_below(c, r)) continue;
      known = 1;
      front.push_back({c, r});
    }
  }
  return found;
}

/// The model of the recipe, opened as often as threads read from it at the same time.
class OpenModels {
 public:
  explicit OpenModels(const Options& shared) : shared_(shared) {}

  /// Calls work(model) with a model that no other thread reads from meanwhile.
  template <class Work>
  void use(const Work& work) {
    std::unique_ptr<const Elevation> model = take();
    work(*model);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(model));
  }

 private:
  std::unique_ptr<const Elevation> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<const Elevation> model = std::move(idle_.back());
        idle_.pop_back();
        return model;
      }
    }
    return std::make_unique<const Elevation>(open_model(shared_));
  }

  const Options& shared_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<const Elevation>> idle_;
};

/// Work on all slides, each with a model that no other reads from.
void for_all(std::size_t count, OpenModels& models, const std::function<void(const Elevation&, std::size_t)>& work) {
  in_threads(
      count, "cutting the parts of the model",
      [&](std::size_t k) { models.use([&](const Elevation& model) { work(model, k); }); }, most_readers);
}

void require_inside(const std::vector<Slide>& slides, const std::vector<CellBox>& boxes, const MapGrid& grid,
                    const std::filesystem::path& model) {
  std::vector<Fault> faults;
  for (std::size_t k = 0; k < slides.size(); ++k) {
    const CellBox& b = boxes[k];
    if (b.west >= 0 && b.south >= 0 && b.east <= grid.columns && b.north <= grid.rows) continue;
    faults.push_back(
        {fmt::format("{} ({}): its outline reaches beyond {}", slides[k].place, slides[k].name, model.string()),
         fmt::format("it covers x {:.0f}..{:.0f}, y {:.0f}..{:.0f}, the model x {:.0f}..{:.0f}, y "
                     "{:.0f}..{:.0f}",
                     grid.west + b.west * grid.cell, grid.west + b.east * grid.cell, grid.south + b.south * grid.cell,
                     grid.south + b.north * grid.cell, grid.west, grid.east(), grid.south, grid.north()),
         "Leave it out (outlines = \"FILE|subset=CONDITION\"), or give a model that holds it"});
  }
  if (!faults.empty()) throw DataError(std::move(faults));
}

/// The lattice that holds all windows, these counted on it, and its coarse ground without values yet.
SlideWindows on_one_lattice(const std::vector<CellBox>& boxes, const MapGrid& grid) {
  CellBox all = boxes.front();
  for (const CellBox& b : boxes)
    all = {std::min(all.west, b.west), std::min(all.south, b.south), std::max(all.east, b.east),
           std::max(all.north, b.north)};
  SlideWindows windows{cut(grid, all.window()), {}, {}};
  for (const CellBox& b : boxes)
    windows.windows.push_back({b.west - all.west, b.south - all.south, b.east - b.west, b.north - b.south});
  const MapGrid& lattice = windows.lattice;
  const int factor = (std::max(lattice.columns, lattice.rows) + ground_side - 1) / ground_side;
  MapGrid& coarse = windows.ground.grid = lattice;
  coarse.cell = lattice.cell * factor;
  coarse.columns = (lattice.columns + factor - 1) / factor;
  coarse.rows = (lattice.rows + factor - 1) / factor;
  windows.ground.values.assign(coarse.count(), nan);
  return windows;
}

/// The ground of one window into the coarse ground: the cell that holds the centre of the coarse one.
void sample_ground(const Elevation& model, const MapGrid& lattice, const CellWindow& window, Raster& ground,
                   std::mutex& mutex) {
  const Raster fine = onto_grid(model, cut(lattice, window));
  const int factor = static_cast<int>(std::lround(ground.grid.cell / lattice.cell));
  const std::lock_guard lock(mutex);
  for (int row = window.row / factor; row <= (window.row + window.rows - 1) / factor; ++row)
    for (int column = window.column / factor; column <= (window.column + window.columns - 1) / factor; ++column) {
      const int c = column * factor + factor / 2 - window.column, r = row * factor + factor / 2 - window.row;
      if (c >= 0 && r >= 0 && c < window.columns && r < window.rows) ground.at(column, row) = fine.at(c, r);
    }
}

}  // namespace

Elevation open_model(const Options& shared) {
  const bool onto = shared.before_dem.empty();
  return read_elevation(onto ? "base_dem" : "before_dem", shared.first_dem(),
                        dem_reading(shared.working_crs, shared.vertical_unit));
}

SlideWindows windows_of(const std::vector<Slide>& slides, const SlideOptions& options, const Options& shared) {
  const Elevation model = open_model(shared);
  const MapGrid grid = working_grid({&model}, grid_request(shared));
  std::vector<CellBox> boxes;
  for (const Slide& slide : slides) boxes.push_back(box_of(slide.outline, grid));
  require_inside(slides, boxes, grid, shared.first_dem());
  OpenModels models(shared);
  if (options.margin) {
    const int margin = std::max(1, static_cast<int>(std::min(1e9, std::ceil(*options.margin / grid.cell))));
    for (CellBox& box : boxes) box = box.grown(margin, grid);
  } else {
    const double tangent = std::tan(options.reach_angle * degrees);
    for_all(slides.size(), models, [&](const Elevation& own, std::size_t k) {
      boxes[k] = ReachOnGround(own, grid, boxes[k], tangent).find().grown(rim, grid);
    });
  }
  SlideWindows windows = on_one_lattice(boxes, grid);
  std::mutex mutex;
  for_all(slides.size(), models, [&](const Elevation& own, std::size_t k) {
    sample_ground(own, windows.lattice, windows.windows[k], windows.ground, mutex);
  });
  return windows;
}

}  // namespace talus::preprocess
