// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From options to the domain: what talus-preprocess does between reading its recipe and writing its file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/domain/domain.hpp"
#include "common/domain/level_set.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/release/releases.hpp"
#include "preprocess/scene/read_scene.hpp"

namespace talus::preprocess {

/// Memory that the solver takes for a material point, in double precision, with its sorting [bytes].
inline constexpr double solver_bytes_per_point = 400;

/// The domain, with its volumes and all that is written beside it.
struct Prepared {
  Domain domain;  // without points where only counted; provenance is left to the caller
  std::size_t point_count = 0;
  Volumes total;
  std::vector<std::pair<std::string, Volumes>> by_release;
  std::vector<std::filesystem::path> inputs;
  std::vector<SolidBody> obstacles;
  double obstacle_voxel = 0;                           // [m]
  std::optional<SlidingSurface> sliding_surface = {};  // where it was computed from an outline
  std::optional<Survey> survey = {};                   // where before and after are given
  std::optional<SurveyedSlide> slide = {};
  DeclaredHeights heights = {};    // of the surface before
  std::string volume_source = {};  // of the released volume, in words that go on "the volume is"
};

/// Adds the file of `source`, which often holds several layers, once; empty: none.
void add_input(std::vector<std::filesystem::path>& inputs, const std::filesystem::path& source);

/// The files that the options name.
std::vector<std::filesystem::path> inputs_of(const Options& options);

/// Whether material points are made, or only counted.
enum class Points { seeded, counted };

/// Reads the files, aligns them, finds or reads the release and seeds its points. Throws RecipeError and DataError.
/// Bed: under the released mass the sliding surface (given or computed), min(before, after), or the base DEM itself
/// (snow lies on it, so the surface before is base + thickness); elsewhere the ground as it is.
Prepared prepare(const Options& options, Points points);

/// The second part: from what was read to the domain. Expects resolved() options, those that `scene` was read with but
/// for what acts here: thickness_factor, erodible layers, bed, layers and points of the grid, obstacles, places.
Prepared prepare(const Options& options, SceneRasters scene, Points points);

/// Throws DataError where a point has no known ground one cell around it, which the solver needs. `file`: the model.
void refuse_points_at_edge(const Domain& domain, const std::filesystem::path& file);

}  // namespace talus::preprocess
