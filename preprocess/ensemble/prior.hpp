// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What `prior` of [ensemble] stands for: friction that another event taught, or that is usual for a class of events.
#pragma once

#include "common/ensemble/options.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// The options with a distribution for each key that `prior` gives and [[ensemble.vary]] does not. Of a posterior.csv
/// these are its keys of [solve], with the rank correlations between them; of a class, the numbers of the bed's law.
/// `prior_source` says in words where they come from. Throws RecipeError: no such file or class, a law or a way of
/// giving friction that the class has no distribution for; and DataError as take_listed() does.
EnsembleOptions with_prior(EnsembleOptions options, const recipe::Recipe& recipe);

}  // namespace talus::preprocess
