// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of many slides over one elevation model: the largest of any, how many come to a place, and their share.
// Values are kept where slides came, and nowhere else: the model may be larger than memory.
#pragma once

#include <functional>
#include <vector>

#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/fields/window.hpp"

namespace talus::postprocess {

/// All of them: of every quantity the largest value, then for each threshold number and share of the slides.
std::vector<EnsembleMap> slide_maps(const Ensemble& ensemble);

/// The values of a map by place of the counts; NaN where no slide came (or none passes the threshold).
std::vector<double> slide_values(const Ensemble& ensemble, const EnsembleMap& map);

/// The part of the lattice in which slides came, and some cells around.
CellWindow reached_cells(const Ensemble& ensemble);

/// That part in map coordinates.
Window reached_part(const Ensemble& ensemble);

/// A map over a part of the lattice, blocks of `factor` x `factor` cells made one: the largest of their values (of a
/// time the smallest); NaN where there is none.
Raster coarse_map(const Ensemble& ensemble, const EnsembleMap& map, const std::vector<double>& values,
                  const CellWindow& part, int factor);

/// Values in some cells of a grid.
struct SparseValues {
  MapGrid grid;
  KeptCells cells;
  std::vector<double> values;  ///< by place; NaN: none
};

/// A map on cells twice as wide, counted from the north-west corner: the largest of four, of a time the smallest.
SparseValues halved(const SparseValues& values, const MapGrid& grid, bool smallest);

/// Every kept block of cells with its values, cut off at the grid's edge.
void each_block(const SparseValues& values, const std::function<void(const Raster&)>& take);

}  // namespace talus::postprocess
