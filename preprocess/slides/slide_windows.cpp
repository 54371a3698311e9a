// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of a large elevation model a slide gets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "common/error.hpp"
#include "common/map/raster.hpp"
#include "common/stage/machine.hpp"
#include "preprocess/slides/slides.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/reach.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr int ground_side = 1000;  // cells of the coarse ground along a side
constexpr std::size_t most_readers = 16;
constexpr double degrees = M_PI / 180;

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
    for_all(slides.size(), models,
            [&](const Elevation& own, std::size_t k) { boxes[k] = reach_of(own, grid, boxes[k], tangent); });
  }
  SlideWindows windows = on_one_lattice(boxes, grid);
  std::mutex mutex;
  for_all(slides.size(), models, [&](const Elevation& own, std::size_t k) {
    sample_ground(own, windows.lattice, windows.windows[k], windows.ground, mutex);
  });
  return windows;
}

}  // namespace talus::preprocess
