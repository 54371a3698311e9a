// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/survey.hpp"

#include <cmath>

#include "preprocess/options/fault.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

namespace {

/// This function declares that `what`, where it is given, needs a second elevation model.
void need_second_model(recipe::Visitor& v, const Options& all, bool given, const std::string& what) {
  v.needs(all.in_laboratory() || !all.after_dem.empty() || !given,
          fault(what + " is given without after_dem", "it speaks of a second elevation model",
                "Give after_dem, or leave it out"));
}

}  // namespace

void CoregistrationOptions::describe(recipe::Visitor& v, const Options& all) {
  recipe::choice(v, "mode", mode, {{"check", Alignment::check}, {"apply", Alignment::apply}, {"off", Alignment::off}},
                 "bring after_dem onto before_dem where nothing moved: check = find shift, height and tilt, and warn; "
                 "apply = correct them");
  need_second_model(v, all, mode == Alignment::apply, "coregistration.mode = \"apply\"");
  v.flag("tilt", tilt, "look for a tilt too; one within its error is left out");
  v.number("steepest_deg", steepest, recipe::Range{0, 90, true, false}, "steeper ground is left out of the fit");
  v.path("changed", changed,
         "polygons of ground to leave out of the fit, besides source and deposit; changes that stand out are found by "
         "themselves");
  need_second_model(v, all, !changed.empty(), "coregistration.changed");
}

void DifferenceOptions::describe(recipe::Visitor& v, const Options& all) {
  recipe::choice(v, "threshold", threshold,
                 {{"probabilistic", Threshold::probabilistic},
                  {"propagated-error", Threshold::propagated_error},
                  {"minimum-level", Threshold::minimum_level}},
                 "level of detection: confidence times the error; the error itself; or minimum_level_m alone");
  v.number("confidence", confidence, recipe::Range{0.5, 0.9999}, "of the probabilistic level, two-sided");
  v.number("minimum_level_m", minimum_level, recipe::not_negative, "the least level of detection in any case");
  v.number("before_sigma_m", before_sigma, recipe::not_negative,
           "standard error of before_dem; 0 for both = the difference's, by slope, from stable ground");
  v.number("after_sigma_m", after_sigma, recipe::not_negative, "that of after_dem");
  need_second_model(v, all, given_sigma() > 0 || minimum_level > 0, "an error or level in [preprocess.difference]");
}

double DifferenceOptions::given_sigma() const { return std::hypot(before_sigma, after_sigma); }

void DepositOptions::describe(recipe::Visitor& v, const Options& all) {
  v.path("polygon", polygon,
         "outline of the surveyed deposit; empty = what rose in the regions of change that belong to the slide: beside "
         "the source, beside one another, or down the way that a flow takes from them");
  need_second_model(v, all, !polygon.empty(), "deposit.polygon");
  v.number("threshold_m", threshold, recipe::not_negative,
           "rise beyond which (and beyond the level of detection) a cell belongs to it");
  v.integer(
      "bridge_cells", bridge_cells, recipe::Range{0, 1000},
      "how far a region may lie beside the slide, or beside its way down, in cells: a thin sheet between them may "
      "lie below the level of detection");
  v.number("longest_gap", longest_gap, recipe::not_negative,
           "how long the way down may be without any change, over the distance that the slide has come so far");
  v.number("steepest_rest_deg", steepest_rest, recipe::Range{0, 90},
           "steeper ground does not count to that gap, since nothing stays there");
  v.number("sure_levels", sure_levels, recipe::not_negative,
           "a region is no noise where enough of it stands out by so many levels of detection");
  v.integer("sure_cells", sure_cells, recipe::Range{1, 1000000},
            "how many cells that must be; without noise (level of detection 0) one is enough");
  v.number("outside_share", outside_share, recipe::not_negative,
           "no score from talus-preprocess's survey where more than this of the larger of source and deposit rose (or "
           "fell) outside the slide and no fall (rise) there balances it");
}

}  // namespace talus::preprocess
