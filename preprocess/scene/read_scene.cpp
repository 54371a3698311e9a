// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/scene/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/laboratory/laboratory.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/release/source.hpp"
#include "preprocess/scene/candidates.hpp"
#include "preprocess/scene/part_of_model.hpp"
#include "preprocess/survey/change.hpp"
#include "preprocess/terrain/elevation.hpp"
#include "preprocess/terrain/plausible_ground.hpp"
#include "preprocess/terrain/reach.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr int enough = 512;  // cells in the middle of a map, each way: they tell how steep it is

/// How an elevation model is read.
ReadOptions reading(const Options& options) { return dem_reading(options.working_crs, options.vertical_unit); }

std::vector<Raster> align(const std::vector<const Elevation*>& dems, const Options& options,
                          std::vector<Filled>* filled = nullptr) {
  return align(dems,
               AlignRequest{.grid = grid_request(options),
                            .edge_nodata = options.grid.edge_nodata,
                            .voids = options.voids,
                            .bytes_per_cell = bytes_per_cell(options)},
               filled);
}

SceneRasters from_source(Raster before, Source source) {
  SceneRasters scene{std::move(before), std::move(source.bed), {}};
  scene.releases.push_back({"source", std::move(source.thickness)});
  return scene;
}

/// What failed between two surveys, found by itself where the recipe does not say it, once the surveys are in order.
Source changed_source(const SurfacePair& pair, const Change& change, const Options& options, const SurveyFiles& files,
                      SurveyMemory* memory) {
  const auto judge = [&] {
    judge_order(order_of(change, sure_regions(change, options.deposit), pair.before), files);
    settle_findings();
  };
  SourceOptions how = options.source;
  if (pair.outline.empty() && how.seed.empty()) {
    const Raster lowering = detected_lowering(pair);
    const std::vector<Region> regions = source_regions(pair, lowering, how);
    judge();
    const auto find = [&] {
      const auto place =
          place_of_slide(candidates_of({pair.before, pair.under, lowering, change}, regions, options.deposit), files);
      return std::vector<double>(place.begin(), place.end());
    };
    how.seed = memory != nullptr ? memory->place(find) : find();
    return find_source(pair, how);
  }
  Source source = find_source(pair, how);
  judge();
  return source;
}

/// What changed between two surveys, and what of it failed.
struct Failed {
  Change change;
  Source source;
};

/// On the grid of both surfaces; `slide` gets source and deposit.
Failed failed_between(const Survey& survey, const std::vector<Raster>& surfaces, SurveyedSlide& slide,
                      const Options& options, SurveyMemory* memory) {
  const Raster &before = surfaces[0], &after = surfaces[1];
  Change change = change_between(before, after, options.deposit, slide);
  const SurveyFiles files{options.before_dem.string(), options.after_dem.string(), survey.applied};
  const SurfacePair pair{before, after, options.after_dem, false, survey.source, change.noise};
  Source source = changed_source(pair, change, options, files, memory);
  delineate(survey, {before, after, source.thickness}, options.deposit, slide);
  return {std::move(change), std::move(source)};
}

Surveyed surveyed(const Options& options) {
  const auto before = static_cast<std::ptrdiff_t>(findings_so_far().size());
  Surveyed result{survey_of(options), {}, std::nullopt};
  std::vector<Filled> filled;
  const std::vector<const Elevation*> dems{&result.survey.before, &result.survey.after};
  const auto outlines = [&](const MapGrid& whole) {
    return seen_from_afar(dems, whole, options, [&](const std::vector<Raster>& surfaces) {
      SurveyedSlide slide = slide_on(result.survey, surfaces[0], {});
      const Failed failed = failed_between(result.survey, surfaces, slide, options, nullptr);
      std::vector<Finding> beyond = findings_so_far();
      std::erase_if(beyond, [](const Finding& finding) { return finding.name != "larger-lowering"; });
      return SlideOutlines{corners_of(failed.source.thickness), corners_of(slide.deposit), "", beyond};
    });
  };
  result.surfaces = align(dems, within_reach(dems, options, outlines), &filled);
  result.slide = slide_on(result.survey, result.surfaces[0], filled);
  if (const auto& ignored = result.slide->ignored; !ignored.empty() && std::ranges::count(ignored, 1) == 0)
    warn("ignore-covers-nothing", options.difference.ignore.string() +
                                      ": covers the centre of no cell of the working grid, so that nothing is ignored");
  const std::vector<Finding> all = findings_so_far();
  result.findings.assign(all.begin() + before, all.end());
  return result;
}

SceneRasters from_before_and_after(const Options& options, SurveyMemory* memory) {
  auto [survey, surfaces, of_slide, found] = memory != nullptr ? memory->surveyed(options) : surveyed(options);
  SurveyedSlide& slide = *of_slide;
  if (!survey.source.empty())
    survey.source = read_united_polygons(options.source.polygon, survey.grid.crs_wkt, options.source.grow, "source");
  const auto [change, source] = failed_between(survey, surfaces, slide, options, memory);
  std::vector<double> lowering;
  for (std::size_t c = 0; c < surfaces[0].values.size(); ++c)
    lowering.push_back(std::isinf(change.noise[c]) ? 0.0 : surfaces[0].values[c] - surfaces[1].values[c]);
  SceneRasters scene = from_source(std::move(surfaces[0]), source);
  scene.lowering = std::move(lowering);
  scene.heights = survey.before.heights();
  scene.survey = std::move(survey);
  scene.slide = std::move(slide);
  return scene;
}

SceneRasters from_sliding_surface(const Options& options) {
  Elevation before = read_elevation("before_dem", options.before_dem, reading(options));
  Elevation sliding = read_elevation("sliding_surface", options.sliding_surface, reading(options));
  share_crs({&before, &sliding}, options.working_crs);
  require_comparable_crs(sliding.crs_wkt(), sliding.file, before.crs_wkt(), before.file.string());
  judge_vertical_datums(before.heights(), sliding.heights());
  const auto source_on = [&](const Raster& ground, const Raster& under) {
    SurfacePair pair{ground, under, options.sliding_surface, true};
    if (!options.source.polygon.empty())
      pair.outline = read_united_polygons(options.source.polygon, ground.grid.crs_wkt, options.source.grow, "source");
    return find_source(pair, options.source);
  };
  const auto outlines = [&](const MapGrid& whole) {
    return seen_from_afar({&before, &sliding}, whole, options, [&](const std::vector<Raster>& surfaces) {
      return SlideOutlines{corners_of(source_on(surfaces[0], surfaces[1]).thickness)};
    });
  };
  Raster ground = align({&before}, within_reach({&before}, options, outlines)).front();
  log_resampling(sliding, ground.grid);
  const Raster under = onto_grid(sliding, ground.grid);
  require_data(under, sliding.file);
  Source source = source_on(ground, under);
  SceneRasters scene = from_source(std::move(ground), std::move(source));
  scene.heights = before.heights();
  return scene;
}

SceneRasters from_outline(const Options& options) {
  Elevation before = read_elevation("before_dem", options.before_dem, reading(options));
  share_crs({&before}, options.working_crs);
  const auto outline = [&](const MapGrid& whole) {
    return SlideOutlines{read_united_polygons(options.source.polygon, whole.crs_wkt, options.source.grow, "source")};
  };
  Raster ground = align({&before}, within_reach({&before}, options, outline)).front();
  ComputedSource computed = source_by_outline(ground, before.heights(), options.source, reading(options));
  SceneRasters scene = from_source(std::move(ground), std::move(computed.source));
  scene.sliding_surface = std::move(computed.computed);
  scene.heights = before.heights();
  return scene;
}

/// Those of the releases; of a raster the rectangle of what it holds. None where a raster lies in another CRS.
std::vector<MapPolygon> outlines_of(const std::vector<ReleaseOptions>& releases, const std::string& crs_wkt) {
  std::vector<MapPolygon> all;
  for (const ReleaseOptions& release : releases) {
    if (!release.polygons.empty()) {
      const auto polygons = read_united_polygons(release.polygons, crs_wkt, release.grow, release.name);
      all.insert(all.end(), polygons.begin(), polygons.end());
      continue;
    }
    const MapGrid content = RasterFile(release.thickness_raster).read_content().grid;
    if (!same_crs(content.crs_wkt, crs_wkt)) return {};
    all.push_back({{{{content.west, content.south}, {content.east(), content.north()}}}, {}, ""});
  }
  return all;
}

SceneRasters from_releases(const Options& options) {
  Elevation base = read_elevation("base_dem", options.base_dem, reading(options));
  share_crs({&base}, options.working_crs);
  const auto outlines = [&](const MapGrid& whole) {
    return SlideOutlines{outlines_of(options.release, whole.crs_wkt)};
  };
  Raster bed = align({&base}, within_reach({&base}, options, outlines)).front();
  SceneRasters scene{bed, std::move(bed), {}};
  scene.heights = base.heights();
  for (std::size_t i = 0; i < options.release.size(); ++i) {
    Release release = read_release(options.release[i], i, scene.bed, base.file);
    for (std::size_t c = 0; c < scene.before.values.size(); ++c) scene.before.values[c] += release.thickness.values[c];
    scene.releases.push_back(std::move(release));
  }
  warn_of_overlap(scene.releases);
  return scene;
}

SceneRasters from_laboratory(const Options& options) {
  Raster ground = laboratory_ground(options);
  SceneRasters scene{box_surface(options, ground), std::move(ground), {}};
  for (std::size_t b = 0; b < options.box.size(); ++b) scene.releases.push_back(box_release(options, b));
  return scene;
}

SceneRasters read_by_way(const Options& options, SurveyMemory* memory) {
  switch (options.way()) {
    case Way::before_and_after: return from_before_and_after(options, memory);
    case Way::before_and_sliding_surface: return from_sliding_surface(options);
    case Way::before_and_outline: return from_outline(options);
    case Way::laboratory: return from_laboratory(options);
    case Way::base_and_releases: break;
  }
  return from_releases(options);
}

}  // namespace

/// What the two surveys are compared by: all but what chooses and shapes the source, and what is made of it.
std::string SurveyMemory::mark_of(Options options) {
  const GridOptions fresh;
  SourceOptions source;
  source.polygon = options.source.polygon;
  source.seed = options.source.seed;  // of a large model the part depends on it
  options.source = source;
  options.deposit = DepositOptions{.polygon = options.deposit.polygon};
  options.thickness_factor = 1;
  options.erodible.clear();
  options.obstacle.clear();
  options.place.clear();
  options.bed = {};
  options.grid.layer_height = fresh.layer_height;
  options.grid.points_per_cell = fresh.points_per_cell;
  options.grid.jitter = fresh.jitter;
  return recipe::to_toml(options, "preprocess", false);
}

Surveyed SurveyMemory::surveyed(const Options& options) {
  const std::string mark = mark_of(options);
  {
    const std::lock_guard lock(mutex_);
    if (kept_ && mark == mark_) {
      add_findings(kept_->findings);
      return *kept_;
    }
  }
  Surveyed found = preprocess::surveyed(options);
  const std::lock_guard lock(mutex_);
  if (!kept_) {
    kept_ = std::make_unique<const Surveyed>(found);
    mark_ = mark;
  }
  return found;
}

Options resolved(Options options) {
  std::vector<Fault> faults;
  recipe::find_unmet(options, faults);
  if (!faults.empty()) throw RecipeError(std::move(faults));
  if (options.working_crs == "utm") options.working_crs = utm_zone_for(options.first_dem());
  return options;
}

SceneRasters read_scene(const Options& given, SurveyMemory* memory) {
  Findings found("preprocess", given.accept);
  SceneRasters scene;
  found.settled([&] {
    scene = read_by_way(resolved(given), memory);
    const Way way = given.way();
    if (way == Way::laboratory) return;
    for (const Release& release : scene.releases) judge_thickness(release.thickness, "release " + release.name);
    if (way == Way::before_and_sliding_surface)
      warn_of_step_at_rim(scene.releases.front().thickness, given.sliding_surface);
    if (scene.survey) return;  // surveys were looked at when they were compared
    judge_lengths(scene.bed.grid, given.working_crs);
    judge_heights(way == Way::base_and_releases ? scene.bed : scene.before, given.first_dem(), given.vertical_unit);
  });
  warn_of_unused("preprocess", given.accept, found.list());
  scene.findings = found.list();
  return scene;
}

Survey survey_of(const Options& given) {
  Options options = given;
  if (options.working_crs == "utm") options.working_crs = utm_zone_for(options.first_dem());
  Elevation before = read_elevation("before_dem", options.before_dem, reading(options));
  Elevation after = read_elevation("after_dem", options.after_dem, reading(options));
  share_crs({&before, &after}, options.working_crs);
  judge_vertical_datums(before.heights(), after.heights());
  Survey survey = compare_surveys(std::move(before), std::move(after), options);
  judge_lengths(survey.grid, given.working_crs);
  const MapGrid& grid = survey.grid;
  const int columns = std::min(enough, grid.columns), rows = std::min(enough, grid.rows);
  judge_heights(
      onto_grid(survey.before, cut(grid, {(grid.columns - columns) / 2, (grid.rows - rows) / 2, columns, rows})),
      options.before_dem, options.vertical_unit);
  return survey;
}

}  // namespace talus::preprocess
