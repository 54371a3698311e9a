// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevation models: which there are, what their heights are in, their voids; and two of them compared.
#pragma once

#include <filesystem>
#include <string>

#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

struct Options;

/// What the heights of elevation models are in: what the files say, or this.
enum class VerticalUnit { declared, metre, foot, us_survey_foot };

/// The keys of [preprocess] itself.
struct ElevationOptions {
  std::filesystem::path before_dem, after_dem, sliding_surface, base_dem;
  std::string working_crs;
  VerticalUnit vertical_unit = VerticalUnit::declared;

  /// The DEM that gives the working grid its CRS, registration and cell.
  const std::filesystem::path& first_dem() const { return base_dem.empty() ? before_dem : base_dem; }
  void describe(recipe::Visitor& v, const Options& all);
};

/// What is done about cells that stand out from their neighbours.
enum class Spikes { ignore, report, remove };

/// The keys of [preprocess.voids].
struct VoidOptions {
  double fill = 0;  ///< largest area that is filled [m2]
  Spikes spikes = Spikes::report;

  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    v.number(
        "fill_m2", fill, recipe::not_negative,
        "voids inside the elevation models of up to this area are filled by natural neighbours; larger ones, and all "
        "with 0, are refused by place");
    recipe::choice(
        v, "spikes", spikes, {{"ignore", Spikes::ignore}, {"report", Spikes::report}, {"remove", Spikes::remove}},
        "cells that stand out from their neighbours (ten times the usual around): remove = make them voids and fill "
        "them");
    need(v, all.in_laboratory() || spikes != Spikes::remove || fill > 0,
         "voids.spikes = \"remove\" without voids.fill_m2", "what is removed is filled like a void",
         "Set fill_m2 = 1e5 in [preprocess.voids], or spikes = \"report\"");
  }
};

/// Declares that `what`, where it is given, needs a second elevation model.
template <class All>
void need_second_model(recipe::Visitor& v, const All& all, bool given, const std::string& what) {
  need(v, all.in_laboratory() || !all.after_dem.empty() || !given, what + " is given without after_dem",
       "it speaks of a second elevation model", "Give after_dem, or leave it out");
}

/// What is done about surveys that do not lie on one another.
enum class Alignment { check, apply, off };

/// The keys of [preprocess.coregistration].
struct CoregistrationOptions {
  Alignment mode = Alignment::check;
  std::filesystem::path changed;

  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    recipe::choice(
        v, "mode", mode, {{"check", Alignment::check}, {"apply", Alignment::apply}, {"off", Alignment::off}},
        "bring after_dem onto before_dem where nothing moved: check = find shift, height and tilt, and warn; "
        "apply = correct them");
    need_second_model(v, all, mode == Alignment::apply, "coregistration.mode = \"apply\"");
    v.path(
        "changed", changed,
        "polygons of ground to leave out of the fit, besides source and deposit; changes that stand out are found by "
        "themselves");
    need_second_model(v, all, !changed.empty(), "coregistration.changed");
  }
};

/// The keys of [preprocess.difference].
struct DifferenceOptions {
  double sigma = 0;              ///< of the difference [m]; 0: learnt from stable ground
  std::filesystem::path ignore;  ///< polygons whose change is not looked at

  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    v.number("sigma_m", sigma, recipe::not_negative,
             "standard error of the difference, the root of the sum of both models' squares; 0 = by slope, from stable "
             "ground");
    need_second_model(v, all, sigma > 0, "difference.sigma_m");
    v.path(
        "ignore", ignore,
        "polygons of lakes, glaciers, forest or quarries, FILE|layername=LAYER|subset=CONDITION (layer \"ignore\" or "
        "the first, where left out): what changed there is neither source nor deposit; outlines of these go first");
    need_second_model(v, all, !ignore.empty(), "difference.ignore");
  }
};

/// The keys of [preprocess.deposit]: what arrived, for after_dem.
struct DepositOptions {
  std::filesystem::path polygon;
  double threshold = 0.5;  ///< [m]

  // Fixed numbers without a key (docs/notes/surveys-and-release.md).
  int bridge_cells = 10;      ///< [cells]
  double longest_gap = 1;     ///< over the distance from the crown to where the gap begins
  double steepest_rest = 30;  ///< [deg]
  double sure_levels = 3;     ///< over the level of detection
  int sure_cells = 5;
  double outside_share = 0.2;  ///< of the larger of source and deposit

  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    v.path(
        "polygon", polygon,
        "outline of the surveyed deposit; empty = what rose in the regions of change that belong to the slide: beside "
        "the source, beside one another, or down the way that a flow takes from them");
    need_second_model(v, all, !polygon.empty(), "deposit.polygon");
    v.number("threshold_m", threshold, recipe::not_negative,
             "rise beyond which (and beyond the level of detection) a cell belongs to it");
  }
};

}  // namespace talus::preprocess
