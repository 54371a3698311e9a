// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A small scene on disk: a random terrain before, and after it with a bowl taken out and a heap laid down elsewhere.
#pragma once

#include "preprocess/scene/prepare.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::test {

/// All material points together [m3].
inline double volume_of_points(const preprocess::Prepared& prepared) {
  Sum sum;
  for (double v : prepared.domain.points.volume) sum.add(v);
  return sum.value();
}

/// What is wrong with options before any file is read, one fault a line.
inline std::string faults_of(preprocess::Options options) {
  std::vector<Fault> faults;
  recipe::find_unmet(options, faults);
  std::string text;
  for (const Fault& fault : faults) text += to_string(fault) + "\n";
  return text;
}

inline void expect_faults(const preprocess::Options& options, const std::string& text) {
  EXPECT_EQ(faults_of(options), text);
}

inline preprocess::Options two_models(const std::filesystem::path& before, const std::filesystem::path& after) {
  preprocess::Options options;
  options.before_dem = before;
  options.after_dem = after;
  return options;
}

/// A release of a thickness on a model.
inline preprocess::Options released_on(const std::filesystem::path& base, const std::filesystem::path& thickness) {
  preprocess::Options options;
  options.base_dem = base;
  options.release.resize(1);
  options.release[0].thickness_raster = thickness;
  return options;
}

/// Options come back from the recipe that is written of them.
inline void expect_read_as_written(const preprocess::Options& options) {
  const std::string text = recipe::to_toml(options, "preprocess", false);
  const Scratch scratch;
  const recipe::Recipe recipe(scratch.write("recipe.toml", text));
  EXPECT_EQ(recipe::to_toml(recipe.read<preprocess::Options>("preprocess"), "preprocess", false), text);
}

struct Scene {
  Scratch scratch;
  MapGrid grid = grid_of(40, 30, 10);
  Raster before, bowl, heap, after;
  preprocess::Options options;

  explicit Scene(unsigned seed = 1) {
    std::mt19937 random(seed);
    before = raster_of(grid, Hills(grid, random));
    const double x0 = grid.west + 130, y0 = grid.south + 170;
    const auto cap = [](double dx, double dy, double radius, double height) {
      return height * std::max(0.0, 1 - (dx * dx + dy * dy) / (radius * radius));
    };
    bowl = raster_of(grid, [&](double x, double y) { return cap(x - x0, y - y0, 65, 20); });
    heap = raster_of(grid, [&](double x, double y) { return cap(x - x0 - 170, y - y0 + 60, 80, 12); });
    after = before;
    for (std::size_t i = 0; i < after.values.size(); ++i) after.values[i] += heap.values[i] - bowl.values[i];
    options.before_dem = write(scratch, "before.tif", before);
    options.after_dem = write(scratch, "after.tif", after);
    options.source.threshold = 0;
    options.accept = {"swapped-surveys", "doubtful-source", "steep-ground"};  // random: mass may go uphill
  }

  /// The scene as base DEM and a release.
  preprocess::ReleaseOptions& as_release() {
    options.base_dem = options.before_dem;
    options.before_dem.clear();
    options.after_dem.clear();
    return options.release.emplace_back();
  }

  void source_outline(const std::string& wkt) { options.source.polygon = write_polygon(scratch, "source.csv", wkt); }
  void rewrite_after(const Raster& raster) { write(scratch, "after.tif", raster); }
  void rewrite_before(const Raster& raster) { write(scratch, "before.tif", raster); }

  preprocess::Prepared prepare() const { return preprocess::prepare(options, preprocess::Points::seeded); }
  std::string data_fault() const {
    return scratch.from_here(fault_of<DataError>([&] { prepare(); }));
  }
  std::string recipe_fault() const {
    return scratch.from_here(fault_of<RecipeError>([&] { prepare(); }));
  }
  std::string path(const std::string& name) const { return (scratch / name).string(); }
};

/// A test with a scene of its own.
struct WithScene : testing::Test, Scene {
  void expect_fault(const std::string& words) const { EXPECT_EQ(data_fault(), words); }
};

}  // namespace talus::test
