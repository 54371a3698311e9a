// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Holes in the elevation models, and cells that stand out of them.
#pragma once

#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

struct Options;

/// What is done about cells that stand out from their neighbours.
enum class Spikes { ignore, report, remove };

/// The keys of [preprocess.voids].
struct VoidOptions {
  double fill = 0;  ///< largest area that is filled [m2]
  Spikes spikes = Spikes::report;

  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const Options& all);
};

}  // namespace talus::preprocess
