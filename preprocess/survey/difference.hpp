// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// After less before, cell by cell, with its level of detection, block by block.
#pragma once

#include <filesystem>
#include <functional>

#include "preprocess/options/options.hpp"
#include "preprocess/survey/error_model.hpp"
#include "preprocess/terrain/elevation.hpp"

namespace talus::preprocess {

/// Level of detection [m] of a cell whose difference has the standard deviation `sigma`, at 95 %, two-sided; 0 where
/// that is not known (NaN).
double level_of_detection(double sigma);

/// One volume with the area it stands on, and its standard error.
struct VolumeWithError {
  double volume = 0, area = 0, error = 0;  // [m3], [m2], [m3]
};

/// What went down, what went up, and the balance, of all cells or of those beyond their level of detection.
struct Budget {
  VolumeWithError erosion, deposition, net;
};

/// Sums the cells of a part of the map and makes their budget.
class BudgetSum {
 public:
  /// One cell: difference and its standard deviation [m].
  void add(double difference, double sigma);
  /// The budget of all cells added so far, on cells of `cell` [m], with errors by `model`.
  Budget budget(const ErrorModel& model, double cell) const;

 private:
  struct Side {
    double sum = 0, squares = 0;
    std::size_t cells = 0;
  };
  static VolumeWithError volume(const Side& side, const ErrorModel& model, double cell);
  Side down_, up_;
  std::size_t level_ = 0;  // cells without any change
  double level_squares_ = 0;
};

/// Before, after and their difference on one block; all on its cells.
struct Block {
  Raster before, after, difference, sigma;
};

/// Walks over a grid block by block (1024 cells wide and high), reading both surveys only there. `visit` sees every
/// block once, from the south-west to the north-east.
void for_each_block(const Elevation& before, const Elevation& after, const MapGrid& grid, const ErrorModel& model,
                    const std::function<void(const Block&)>& visit);

/// Both budgets of one pair.
struct Budgets {
  Budget raw, thresholded;
};

}  // namespace talus::preprocess
