// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/scene/prepare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "common/error.hpp"
#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"
#include "common/recipe/dataset_name.hpp"
#include "common/recipe/paths.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/laboratory/laboratory.hpp"
#include "preprocess/obstacle/obstacles.hpp"
#include "preprocess/particles/seed.hpp"
#include "preprocess/scene/bed_zones.hpp"
#include "preprocess/scene/places.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

/// What went down where nothing fails: the layer that the slide took along.
Release lowered_outside_source(const SceneRasters& scene, const std::string& name) {
  Release layer{name, {scene.bed.grid, std::vector<double>(scene.bed.grid.count(), 0.0)}};
  bool any = false;
  for (std::size_t c = 0; c < scene.lowering.size(); ++c) {
    if (!(scene.lowering[c] > 0) || scene.releases.front().thickness.values[c] > 0) continue;
    layer.thickness.values[c] = scene.lowering[c];
    any = true;
  }
  if (!any)
    throw DataError({"[[preprocess.erodible]] lowering = true: nothing lies lower outside the source",
                     "no ground was eroded", "Leave it out, or raise source.threshold_m"});
  return layer;
}

/// [preprocess] thickness_factor: the bed stays, the surface before follows.
void scale_thickness(double factor, SceneRasters& scene) {
  if (factor == 1) return;
  for (Release& release : scene.releases) {
    for (std::size_t c = 0; c < release.thickness.values.size(); ++c) {
      double& thickness = release.thickness.values[c];
      if (!(thickness > 0)) continue;
      scene.before.values[c] += (factor - 1) * thickness;
      thickness *= factor;
    }
  }
}

/// Points of boxes, which stand on the ground; [preprocess] thickness_factor stretches their lattice.
SeedPoints points_of_boxes(const Options& options) {
  SeedPoints points = seed_boxes(options);
  for (auto* values : {&points.height, &points.volume})
    for (double& value : *values) value *= options.thickness_factor;
  return points;
}

/// Takes the erodible layers out of the bed, and puts them below everything that is released.
void lay_erodible(const Options& options, SceneRasters& scene) {
  std::vector<Release> layers;
  for (std::size_t e = 0; e < options.erodible.size(); ++e) {
    ErodibleOptions o = options.erodible[e];
    if (o.name.empty()) o.name = fmt::format("erodible-{}", e + 1);
    layers.push_back(o.lowering ? lowered_outside_source(scene, o.name)
                                : read_release(o, e, scene.bed, options.first_dem()));
  }
  warn_of_overlap(layers);
  for (const Release& layer : layers)
    for (std::size_t c = 0; c < scene.bed.values.size(); ++c) scene.bed.values[c] -= layer.thickness.values[c];
  scene.releases.insert(scene.releases.begin(), std::make_move_iterator(layers.begin()),
                        std::make_move_iterator(layers.end()));
}

std::vector<std::pair<std::string, Raster>> read_bed(const Options& options, const MapGrid& grid) {
  const bool reproject = !options.working_crs.empty();
  std::vector<std::pair<std::string, Raster>> rasters;
  for (const BedRaster& one : options.bed.rasters) {
    const auto& file = one.file;
    const std::string name(one.name());
    const Elevation values = read_elevation("bed." + name, file,
                                            {.to_crs = reproject ? grid.crs_wkt : "",
                                             .vertical_unit = {},
                                             .or_else = dem_reading("", VerticalUnit::declared).or_else,
                                             .are_lengths = false});
    require_comparable_crs(values.crs_wkt(), values.file, grid.crs_wkt, options.first_dem().string());
    log_resampling(values, grid);
    Raster raster = onto_grid(values, grid);
    require_data(raster, file);
    std::vector<char> negative(raster.values.size());
    for (std::size_t i = 0; i < negative.size(); ++i) negative[i] = raster.values[i] < 0;  // false for nodata
    refuse_cells(
        grid, negative, file,
        {"negative values of " + name, "it has none", "Mend the raster; no data means the number in [solve.base]"});
    rasters.emplace_back(name, std::move(raster));
  }
  return rasters;
}

/// Of what is released: the releases from the `first` one on.
Raster total_thickness(const SceneRasters& scene, std::size_t first) {
  Raster total{scene.bed.grid, std::vector<double>(scene.bed.grid.count(), 0.0)};
  for (std::size_t r = first; r < scene.releases.size(); ++r)
    for (std::size_t i = 0; i < total.values.size(); ++i) total.values[i] += scene.releases[r].thickness.values[i];
  return total;
}

/// The height of the layers [m].
double layer_height(const Options& options, const Raster& release) {
  if (options.grid.layer_height > 0) return options.grid.layer_height;
  return options.way() == Way::laboratory ? options.grid.spacing : default_layer_height(release, release.grid.cell);
}

void warn_at_edge(const Raster& thickness) {
  const MapGrid& grid = thickness.grid;
  for (std::size_t i = 0; i < thickness.values.size(); ++i) {
    const auto [column, row] = grid.cell_of(i);
    const bool edge = column == 0 || row == 0 || column == grid.columns - 1 || row == grid.rows - 1;
    if (!edge || !(thickness.values[i] > 0)) continue;
    warn("release-at-edge",
         "the release reaches the edge of the working grid, at " + place_of(grid, i) + ": part of it may lie beyond");
    return;
  }
}

/// The releases by name, with the volume of each and of all.
void add_volumes(const SceneRasters& scene, Prepared& prepared) {
  const std::vector<double> cosine = slope_cosine(scene.bed);
  prepared.total = volumes_of(prepared.domain.release_thickness, cosine);
  for (const Release& release : scene.releases) {
    prepared.domain.release_names.push_back(release.name);
    prepared.by_release.emplace_back(release.name, volumes_of(release.thickness, cosine));
    prepared.by_release.back().second.given = release.given;
  }
  if (std::ranges::all_of(scene.releases, [](const Release& r) { return r.given == Direction::slope_normal; }))
    prepared.total.given = Direction::slope_normal;
}

/// Refuses more points than can be numbered or held, and warns of so many that they take long.
void judge_count(std::size_t points, const GridOptions& grid) {
  constexpr double bytes_per_seed = 64;  // places, volume, extents, release
  constexpr double many = 1e7;
  const auto count = static_cast<double>(points);
  const bool dense = grid.points_per_cell[0] * grid.points_per_cell[1] * grid.points_per_cell[2] > 1;
  const std::string mend =
      "Take a larger layer_height_m or spacing_m" +
      (dense ? fmt::format(", or fewer points_per_cell than [{}]", fmt::join(grid.points_per_cell, ", "))
             : std::string());
  const std::string what = fmt::format("[preprocess.grid]: {} material points", grouped(count));
  if (points > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw RecipeError({what, "points are numbered in 32 bits", mend});
  require_memory(bytes_per_seed * count, what, mend);
  if (count > many)
    warn("many-points",
         to_string(Fault{what,
                         fmt::format("to make so many takes long, and the solver needs about {:.0f} GB for them",
                                     count * solver_bytes_per_point * 1e-9),
                         mend}),
         {{"material_points", count, "1"}});
}

/// Of a source under an outline.
std::string volume_under_outline(const SlidingSurfaceOptions& given) {
  if (given.ways_given() == 0) return "guessed from the area of its outline, an order of magnitude";
  if (!given.depth_points.empty()) return "that of a surface computed through depth points under its outline";
  return given.depth > 0 ? "that of a surface computed for a depth that the recipe gives" : "given by the recipe";
}

std::string volume_source_of(const Options& options, const Prepared& prepared) {
  if (options.no_release) return "what the recipe's hydrographs let in";
  std::string from;
  switch (options.way()) {
    case Way::laboratory: from = "that of the recipe's boxes"; break;
    case Way::base_and_releases: from = "given by the recipe, as thickness or volume"; break;
    case Way::before_and_sliding_surface: from = "measured down to a sliding surface that the recipe gives"; break;
    case Way::before_and_outline: from = volume_under_outline(options.source.sliding_surface); break;
    case Way::before_and_after: {
      const double error =
          prepared.slide && !prepared.slide->volumes.empty() ? prepared.slide->volumes.front().volume.error : nan;
      from = "measured between two elevation models, " +
             (std::isfinite(error) ? fmt::format("with a standard error of {} m3", grouped(error))
                                   : std::string("of an error that is not known"));
    }
  }
  if (options.thickness_factor != 1) from += fmt::format(", times {:g} by the recipe", options.thickness_factor);
  return from;
}

}  // namespace

void add_input(std::vector<std::filesystem::path>& inputs, const std::filesystem::path& source) {
  const std::filesystem::path file = file_behind(vector_source(source).file);
  if (!file.empty() && std::find(inputs.begin(), inputs.end(), file) == inputs.end()) inputs.push_back(file);
}

std::vector<std::filesystem::path> inputs_of(const Options& options) {
  std::vector<std::filesystem::path> inputs;
  const auto add = [&](const std::filesystem::path& source) { add_input(inputs, source); };
  for (const auto& file : {options.before_dem, options.after_dem, options.sliding_surface, options.base_dem,
                           options.source.polygon, options.source.sliding_surface.depth_points,
                           options.coregistration.changed, options.difference.ignore, options.deposit.polygon})
    add(file);
  for (const ReleaseOptions& layer : options.erodible) {
    add(layer.thickness_raster);
    add(layer.polygons);
  }
  for (const ReleaseOptions& release : options.release) {
    add(release.thickness_raster);
    add(release.polygons);
  }
  for (const BedRaster& raster : options.bed.rasters) add(raster.file);
  add(options.bed.polygons);
  for (const BedZone& zone : options.bed.zones) add(zone.polygons);
  for (const ObstacleOptions& obstacle : options.obstacle) add(obstacle.polygons);
  for (const PlaceOptions& place : options.place) add(place.file);
  return inputs;
}

Prepared prepare(const Options& given, Points points) {
  SceneRasters scene = read_scene(given);
  return prepare(resolved(given), std::move(scene), points);
}

Prepared prepare(const Options& options, SceneRasters scene, Points points) {
  scale_thickness(options.thickness_factor, scene);
  const Findings found("preprocess");
  lay_erodible(options, scene);
  Prepared prepared;
  prepared.domain.release_thickness = total_thickness(scene, options.erodible.size());
  const Seeding seeding = seeding_of(options.grid, layer_height(options, prepared.domain.release_thickness));
  prepared.inputs = inputs_of(options);
  const bool laboratory = options.way() == Way::laboratory;
  prepared.point_count = laboratory ? count_box_points(options) : count_points(scene.releases, seeding);
  judge_count(prepared.point_count, options.grid);
  if (!laboratory)
    warn_of_coarseness(prepared.domain.release_thickness, seeding.layer_height, prepared.point_count, options.grid);

  Domain& domain = prepared.domain;
  domain.grid = scene.bed.grid;
  domain.layer_height = seeding.layer_height;
  warn_at_edge(domain.release_thickness);
  add_volumes(scene, prepared);
  stop_if_interrupted("preparing the domain");
  if (points == Points::seeded)
    domain.points = laboratory ? points_of_boxes(options) : seed_points(scene.releases, seeding);
  domain.erodible = static_cast<int>(options.erodible.size());
  domain.bed = read_bed(options, domain.grid);
  if (!options.bed.polygons.empty()) lay_bed_polygons(options.bed.polygons, scene.bed, domain.bed);
  lay_bed_zones(options.bed.zones, scene.bed, domain.bed);
  prepared.obstacles = upright_obstacles(options.obstacle, scene.bed, 2 * domain.layer_height);
  prepared.obstacle_voxel = obstacle_voxel(domain.grid.cell, domain.layer_height);
  domain.places = read_places(options.place, scene.bed);
  domain.terrain = std::move(scene.bed);
  domain.before = std::move(scene.before);
  prepared.sliding_surface = std::move(scene.sliding_surface);
  prepared.survey = std::move(scene.survey);
  prepared.slide = std::move(scene.slide);
  prepared.heights = std::move(scene.heights);
  prepared.volume_source = volume_source_of(options, prepared);
  domain.findings = std::move(scene.findings);
  domain.findings.insert(domain.findings.end(), found.list().begin(), found.list().end());
  return prepared;
}

void refuse_points_at_edge(const Domain& domain, const std::filesystem::path& file) {
  const MapGrid& grid = domain.grid;
  std::vector<char> at_edge(grid.count());
  for (std::size_t p = 0; p < domain.points.size(); ++p) {
    const auto [column, row, layer] = nearest_cell(grid, domain.layer_height, domain.points, p);
    const int i = std::clamp(column, 0, grid.columns - 1), j = std::clamp(row, 0, grid.rows - 1);
    bool known = i == column && j == row && i > 0 && j > 0 && i < grid.columns - 1 && j < grid.rows - 1;
    for (int r = j - 1; known && r <= j + 1; ++r)
      for (int c = i - 1; c <= i + 1; ++c) known = known && !std::isnan(domain.terrain.at(c, r));
    at_edge[grid.index(i, j)] = !known;
  }
  refuse_cells(grid, at_edge, file,
               {"cells of release at the edge of the known ground", "a point needs known ground one cell around it",
                "Give a larger elevation model or extent_m, or cut the release"});
}

}  // namespace talus::preprocess
