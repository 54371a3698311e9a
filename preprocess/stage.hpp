// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stage talus-preprocess: elevation models -> domain.vdb, survey/, obstacles.vdb, members.h5.
#pragma once

#include "common/ensemble/options.hpp"
#include "common/stage/stage.hpp"

namespace talus::preprocess {

/// The stage with flags of its own: each call of the function makes another set of flags.
Stage stage();

/// The [ensemble] of a recipe with the distributions that its `prior` stands for. Throws RecipeError and DataError.
EnsembleOptions ensemble_with_prior(const recipe::Recipe& recipe);

}  // namespace talus::preprocess
