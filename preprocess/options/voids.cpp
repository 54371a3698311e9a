// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/voids.hpp"

#include "preprocess/options/fault.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

void VoidOptions::describe(recipe::Visitor& v, const Options& all) {
  v.flag("fill", fill, "fill voids inside the elevation models by natural neighbours; else they are refused by place");
  v.number("largest_m2", largest, recipe::not_negative, "area of the largest void that is filled");
  recipe::choice(
      v, "spikes", spikes, {{"ignore", Spikes::ignore}, {"report", Spikes::report}, {"remove", Spikes::remove}},
      "cells that stand out from their neighbours (ten times the usual around): remove = make them voids and fill "
      "them");
  v.needs(all.in_laboratory() || spikes != Spikes::remove || fill,
          fault("voids.spikes = \"remove\" without voids.fill", "what is removed is filled like a void",
                "Set fill = true in [preprocess.voids], or spikes = \"report\""));
}

}  // namespace talus::preprocess
