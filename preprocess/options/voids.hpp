// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Holes in the elevation models, and cells that stand out of them.
#pragma once

#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

/// What is done about cells that stand out from their neighbours.
enum class Spikes { ignore, report, remove };

/// The keys of [preprocess.voids].
struct VoidOptions {
  double fill = 0;  ///< largest area that is filled [m2]
  Spikes spikes = Spikes::report;

  /// The method declares the keys with defaults, help and what they need of `all` others.
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
    v.needs(all.in_laboratory() || spikes != Spikes::remove || fill > 0,
            fault("voids.spikes = \"remove\" without voids.fill_m2", "what is removed is filled like a void",
                  "Set fill_m2 = 1e5 in [preprocess.voids], or spikes = \"report\""));
  }
};

}  // namespace talus::preprocess
