// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/release/rim_problem.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/error.hpp"

namespace talus::preprocess {

namespace {

/// Calls use(side, cell) for the neighbours on the grid; a side without one is passed as `none`.
constexpr std::size_t none = static_cast<std::size_t>(-1);
template <class Use>
void for_neighbours(const MapGrid& grid, std::size_t cell, Use use) {
  const int column = static_cast<int>(cell % static_cast<std::size_t>(grid.columns)),
            row = static_cast<int>(cell / static_cast<std::size_t>(grid.columns));
  for (std::size_t side = 0; side < 4; ++side) {
    const int c = column + neighbour_steps[side][0], r = row + neighbour_steps[side][1];
    const bool there = c >= 0 && r >= 0 && c < grid.columns && r < grid.rows;
    use(side, there ? grid.index(c, r) : none);
  }
}

}  // namespace

RimProblem::RimProblem(const Outline& outline)
    : operator_(static_cast<Eigen::Index>(outline.cells.size()), static_cast<Eigen::Index>(outline.cells.size())) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(5 * outline.cells.size());
  for (std::size_t i = 0; i < outline.cells.size(); ++i) {
    double diagonal = 0;
    for_neighbours(outline.grid, outline.cells[i], [&](std::size_t side, std::size_t cell) {
      const int n = cell == none ? -1 : outline.number[cell];
      diagonal += n < 0 ? 1 / outline.reach[i][side] : 1;
      if (n >= 0) entries.emplace_back(static_cast<int>(i), n, -1.0);
    });
    entries.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal);
  }
  operator_.setFromTriplets(entries.begin(), entries.end());
  factors_.analyzePattern(operator_);
  hold(std::vector<char>(outline.cells.size(), 0));
}

void RimProblem::hold(const std::vector<char>& held) {
  held_ = held;
  Matrix system = operator_;  // the pattern stays, so that its ordering is found once
  for (Eigen::Index j = 0; j < system.outerSize(); ++j) {
    for (Matrix::InnerIterator entry(system, j); entry; ++entry) {
      const bool fixed = held_[static_cast<std::size_t>(entry.row())] || held_[static_cast<std::size_t>(entry.col())];
      if (fixed && entry.row() != entry.col()) entry.valueRef() = 0;
    }
  }
  factors_.factorize(system);
  if (factors_.info() == Eigen::Success) return;
  throw NumericalError(Fault{fmt::format("sliding surface: the system of {} cells cannot be factorised", held_.size()),
                             "its matrix is not positive definite", "Please report it, with the outline"});
}

RimProblem::Vector RimProblem::solve(Vector load) const {
  for (Eigen::Index i = 0; i < load.size(); ++i) {
    if (held_[static_cast<std::size_t>(i)]) load[i] = 0;
  }
  return factors_.solve(load);
}

RimProblem::Vector ground_curvature(const Raster& before, const Outline& outline) {
  RimProblem::Vector curvature(static_cast<Eigen::Index>(outline.cells.size()));
  for (std::size_t i = 0; i < outline.cells.size(); ++i) {
    const double here = before.values[outline.cells[i]];
    double sum = 0;
    for_neighbours(outline.grid, outline.cells[i], [&](std::size_t, std::size_t cell) {
      if (cell != none && !std::isnan(before.values[cell])) sum += before.values[cell] - here;
    });
    curvature[static_cast<Eigen::Index>(i)] = sum;
  }
  return curvature;
}

}  // namespace talus::preprocess
