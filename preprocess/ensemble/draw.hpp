// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The members of an ensemble, drawn by a design as [ensemble] says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/ensemble/member_table.hpp"
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

/// Draws the members: their number, and the value of each key in each of them; own_domain and provenance are left to
/// the caller. Equal options give equal tables. Throws RecipeError where the design does not go with what varies, and
/// as Marginal, copula_of() and unit_design() do; DataError as take_listed() does.
MemberTable draw_members(const EnsembleOptions& options);

/// What people read of a table: the design and its number of members, and smallest value, mean and largest of each key.
std::vector<std::string> as_lines(const MemberTable& table, const EnsembleOptions& options);

}  // namespace talus::preprocess
