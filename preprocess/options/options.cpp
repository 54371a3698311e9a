// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

void Options::describe(recipe::Visitor& v) {
  ElevationOptions::describe(v, *this);
  v.names("accept", accept, {"swapped-surveys", "false-lengths", "steep-ground"},
          "what is refused because it is hardly ever right, and here is; it goes with all results");
  v.flag("no_release", no_release,
         "base_dem or a laboratory without releases: all that moves enters by [[solve.inflow]]");
  v.needs(!no_release || (before_dem.empty() && release.empty() && box.empty()),
          fault("no_release = true beside before_dem, [[preprocess.release]] or [[preprocess.box]]",
                "they say what is released", "Leave one of them out; an inflow may enter beside a release"));
  v.needs(!no_release || grid.layer_height > 0,
          fault("no_release = true without grid.layer_height_m", "there is no release whose thickness it could follow",
                "Give a half of the depth that the flow will have"));
  v.number("thickness_factor", thickness_factor, recipe::positive,
           "the released thickness times this; the bed and the outline stay, the surface before follows");
  v.needs(thickness_factor == 1 || std::all_of(box.begin(), box.end(), [](const auto& b) { return !(b.bottom > 0); }),
          fault(fmt::format("thickness_factor = {:g} with a box whose bottom lies above the ground", thickness_factor),
                "it would be lifted, not made thicker", "Give extent_m of the boxes instead"));
  recipe::table(v, "coregistration", coregistration, "for (1): after_dem brought onto before_dem", *this);
  recipe::table(v, "difference", difference, "for (1): after_dem less before_dem, and from where on it is believed",
                *this);
  recipe::table(v, "deposit", deposit, "for (1): what arrived, written for the score", *this);
  recipe::table(v, "source", source, "what fails, for (1), (2) and (5)", *this);
  recipe::table(v, "grid", grid, "background grid and material points");
  recipe::table(v, "voids", voids, "cells without elevation inside the elevation models, and cells that stand out",
                *this);
  describe_layers(v, *this);
  recipe::table(v, "laboratory", laboratory, "(4) a plane instead of elevation models, with [[preprocess.box]]", *this);
  recipe::list(v, "box", box, "a block of material on or above that plane; may be repeated");
  describe_obstacles(v, obstacle);
  describe_places(v, place);
  recipe::table(v, "bed", bed, "friction of the bed from place to place");
}

void Options::check(std::vector<Fault>& faults) const {
  if (laboratory.has_cells() && grid.stands_alone()) check_boxes(*this, faults);
}

Way Options::way() const {
  if (laboratory.given()) return Way::laboratory;
  if (!base_dem.empty()) return Way::base_and_releases;
  if (!after_dem.empty()) return Way::before_and_after;
  return sliding_surface.empty() ? Way::before_and_outline : Way::before_and_sliding_surface;
}

}  // namespace talus::preprocess
