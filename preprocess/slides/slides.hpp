// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Many slides over one elevation model: what [slides] of a recipe lists, the part of the model that each gets, and
// their domains.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"
#include "common/gis/features.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/ensemble/ensemble.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {

/// The elevation model of [preprocess]: base_dem, onto which a slide is laid, or before_dem, out of which it is cut.
enum class ModelIs { base, before };

/// The keys that say how much a slide releases: laid onto base_dem, cut out of before_dem.
inline constexpr const char* thickness_key = "preprocess.release[0].thickness_m";
inline constexpr const char* volume_key = "preprocess.release[0].volume_m3";
inline constexpr const char* cut_keys[] = {"preprocess.source.sliding_surface.depth_m",
                                           "preprocess.source.sliding_surface.volume_m3"};

/// Whether a key is one of these.
inline bool is_amount(std::string_view key) {
  return key == thickness_key || key == volume_key || key == cut_keys[0] || key == cut_keys[1];
}

/// Which of them the recipe means. Throws RecipeError: neither or both are given, or what fails is given besides.
ModelIs model_of(const recipe::Recipe& recipe);

/// The options of [preprocess] that all slides share; what fails is that of any. Reads no layer. Throws RecipeError.
Options shared_options(const recipe::Recipe& recipe, const SlideOptions& slides);

/// The elevation model of the recipe; each thread opens it for itself.
Elevation open_model(const Options& shared);

/// One slide, as the recipe and the attributes of its polygons give it.
struct Slide {
  std::string name;
  std::string place;                                     ///< where it is given, for messages
  std::filesystem::path source;                          ///< its polygons in a vector file
  std::vector<MapPolygon> outline;                       ///< these, in the CRS of the model
  std::vector<std::pair<std::string, std::string>> set;  ///< keys of the recipe and their values

  bool sets(std::string_view key) const {
    return std::ranges::any_of(set, [&](const auto& one) { return one.first == key; });
  }
};

/// The slides that a recipe lists, in the order of layer and list; every layer is read once. Throws DataError and
/// RecipeError with all that is wrong: no polygons, missing or NULL attributes, names twice, keys not set for all.
std::vector<Slide> list_slides(const SlideOptions& options, ModelIs model, const std::string& crs_wkt);

/// The parts of the model that slides get.
struct SlideWindows {
  MapGrid lattice;                  ///< holds all of them
  std::vector<CellWindow> windows;  ///< [slides], among the cells of the lattice
  Raster ground;                    ///< the model within them, at the centres of coarser cells [m]; NaN elsewhere
};

/// The windows of all slides, in parallel; only the cells within are read. Throws DataError: outlines beyond the model.
SlideWindows windows_of(const std::vector<Slide>& slides, const SlideOptions& options, const Options& shared);

/// The members that slides are.
EnsemblePlan plan_of(const recipe::Recipe& recipe, const std::vector<Slide>& slides, const SlideWindows& windows,
                     ModelIs model);

struct SlidesMade {
  std::vector<std::filesystem::path> inputs;  ///< files that were read
  Facts facts;                                ///< for the used recipe
  std::filesystem::path largest;              ///< the domain with the most points; empty: nothing was written
};

/// talus-preprocess for [slides]: members.h5 and a domain for each slide; with context.check_only nothing is written.
SlidesMade make_slides(StageContext& context);

/// domain.vdb: a copy of the domain with the most points, by which talus-solve plans. Where it lies, all is there.
void copy_largest(StageContext& context, const SlidesMade& made);

/// The files that a recipe with [slides] reads.
std::vector<std::filesystem::path> inputs_of_slides(const recipe::Recipe& recipe);

}  // namespace talus::preprocess
