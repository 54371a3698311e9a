// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/voids.hpp"

#include "preprocess/options/fault.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

void VoidOptions::describe(recipe::Visitor& v, const Options& all) {
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

}  // namespace talus::preprocess
