// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/deposit_difference.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/gis/resampling.hpp"
#include "common/map/statistics.hpp"
#include "common/map/sum.hpp"

namespace talus::postprocess {
namespace {

double thickness_or_none(double value) { return std::isfinite(value) ? value : 0; }

bool same_cells(const MapGrid& a, const MapGrid& b) {
  return a.columns == b.columns && a.rows == b.rows && a.west == b.west && a.south == b.south && a.cell == b.cell &&
         a.crs_wkt == b.crs_wkt;
}

}  // namespace

DepositDifference deposit_difference(const RunMaps& first, const RunMaps& second, double threshold) {
  const Raster theirs_as_is{second.grid, second.deposit_thickness};
  const Raster other =
      same_cells(first.grid, second.grid) ? theirs_as_is : resample_thickness(theirs_as_is, first.grid);
  DepositDifference found{.difference = {first.grid, std::vector<double>(first.grid.count(), nan)}};
  Sum ours, theirs, squares;
  std::vector<double> changes;
  std::size_t both = 0, either = 0;
  for (std::size_t i = 0; i < first.grid.count(); ++i) {
    const double a = thickness_or_none(first.deposit_thickness[i]), b = thickness_or_none(other.values[i]);
    ours.add(a);
    theirs.add(b);
    if (a > 0 || b > 0) found.difference.values[i] = b - a;
    found.larger = std::max(found.larger, b - a);
    found.smaller = std::max(found.smaller, a - b);
    both += a > threshold && b > threshold;
    if (!(a > threshold) && !(b > threshold)) continue;
    ++either;
    squares.add((b - a) * (b - a));
    changes.push_back(std::abs(b - a));
  }
  const double area = first.grid.cell * first.grid.cell, scale = theirs.value() > 0 ? ours.value() / theirs.value() : 0;
  Sum moved;
  for (std::size_t i = 0; i < first.grid.count(); ++i)
    moved.add(0.5 *
              std::abs(thickness_or_none(first.deposit_thickness[i]) - scale * thickness_or_none(other.values[i])));
  found.volume = (theirs.value() - ours.value()) * area;
  found.moved = ours.value() > 0 ? moved.value() / ours.value() : 0;
  found.overlap = either > 0 ? static_cast<double>(both) / static_cast<double>(either) : 1;
  found.p99 = either > 0 ? quantile(std::move(changes), 0.99) : 0;
  found.rms = either > 0 ? std::sqrt(squares.value() / static_cast<double>(either)) : 0;
  return found;
}

}  // namespace talus::postprocess
