// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where the members of an ensemble lie in the unit cube of their keys.
#pragma once

#include <cstdint>
#include <vector>

#include "common/ensemble/options.hpp"

namespace talus::preprocess {

/// A design: for each member a share 0 < u < 1 of each key.
struct UnitDesign {
  std::vector<std::vector<double>> shares;  ///< [members][keys]
  std::int64_t sample_size = 0;             ///< sensitivity: N of the N (d + 2) members, in the order of OpenTURNS
};

/// Sobol's sequence (shifted by the seed modulo 1: Cranley and Patterson 1976), Latin hypercube, optimal Latin
/// hypercube (Damblin, Couplet and Iooss 2013: simulated annealing on the centred L2 discrepancy), independent draws,
/// and Saltelli's two samples with their mixtures (the largest N with N (d + 2) <= members). Equal seeds give equal
/// designs. Throws RecipeError: more keys than Sobol's sequence has directions, fewer members than a design needs, an
/// optimal hypercube too large to be improved in a reasonable time.
UnitDesign unit_design(Design design, int members, std::size_t keys, int seed);

/// All combinations of one level of each key, whose numbers of levels are `counts`: places among the levels
/// [members][keys]. Throws RecipeError for more than `most` members.
std::vector<std::vector<std::size_t>> combinations(const std::vector<std::size_t>& counts, double most);

}  // namespace talus::preprocess
