// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace talus::preprocess {

/// The values of the cells [rows * columns] that count, and a smooth surface through them in the others: means over 2 x
/// 2, 4 x 4, ... cells, blended linearly from the coarsest on (pull-push of Gortler et al. 1996, "The Lumigraph").
/// Linear in the values: what two fields have in common, their filled ones have. 0 throughout where no cell counts.
std::vector<double> smooth_fill(const std::vector<double>& values, const std::vector<char>& counts, int columns,
                                int rows);

}  // namespace talus::preprocess
