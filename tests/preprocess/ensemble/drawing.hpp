// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ensembles for the tests of this folder.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/ensemble/options.hpp"
#include "common/error.hpp"
#include "preprocess/ensemble/draw.hpp"
#include "tests/common/scratch.hpp"

namespace talus::test {

/// An ensemble with the keys a, b, c ... of [solve], each uniform between 0 and 1.
inline EnsembleOptions ensemble(int members, Design design, int keys) {
  EnsembleOptions o;
  o.members = members;
  o.design = design;
  for (int k = 0; k < keys; ++k) {
    VaryOptions& vary = o.vary.emplace_back();
    vary.key = std::string("solve.") + static_cast<char>('a' + k);
    vary.low = 0;
    vary.high = 1;
  }
  return o;
}

/// What reading an [ensemble] finds wrong, one fault a line.
inline std::string faults_of_recipe(const std::string& text) {
  const Scratch scratch;
  return fault_of<RecipeError>([&] { ensemble_of(recipe::Recipe(scratch.write("recipe.toml", text))); });
}

}  // namespace talus::test
