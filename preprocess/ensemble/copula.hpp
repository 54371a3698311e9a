// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Keys that vary together: a normal copula.
#pragma once

#include <memory>
#include <vector>

#include "common/ensemble/openturns.hpp"
#include "common/ensemble/options.hpp"

namespace talus::preprocess {

/// The normal copula with Spearman's rank correlations between keys, whose order `vary` gives; none where no keys vary
/// together. Throws RecipeError where no such correlations can be together (their matrix is not positive definite), or
/// where one pair is there twice.
std::shared_ptr<const openturns::Copula> copula_of(const std::vector<VaryOptions>& vary,
                                                   const std::vector<CorrelationOptions>& correlations);

}  // namespace talus::preprocess
