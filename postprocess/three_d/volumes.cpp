// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/three_d/volumes.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/three_d/share_among_cells.hpp"

namespace talus::postprocess {
namespace {

/// The bed with every cell filled: where it has none, that of the nearest cell that has, counted in steps of one cell.
std::vector<double> filled_bed(const MapGrid& grid, std::vector<double> bed) {
  std::deque<std::size_t> front;
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (!std::isnan(bed[i])) front.push_back(i);
  const auto columns = static_cast<std::size_t>(grid.columns);
  while (!front.empty()) {
    const std::size_t i = front.front();
    front.pop_front();
    const auto take = [&](bool inside, std::size_t next) {
      if (!inside || !std::isnan(bed[next])) return;
      bed[next] = bed[i];
      front.push_back(next);
    };
    take(i % columns > 0, i - 1);
    take(i % columns + 1 < columns, i + 1);
    take(i >= columns, i - columns);
    take(i + columns < bed.size(), i + columns);
  }
  return bed;
}

int division_of(const MapGrid& grid, double layer_height, double side) {
  if (side == 0) return std::max(1, static_cast<int>(std::ceil(grid.cell / layer_height - 1e-9)));
  const double parts = std::round(grid.cell / side);
  if (parts < 1 || std::abs(parts * side - grid.cell) > 1e-6 * grid.cell)
    throw DataError({fmt::format("[postprocess.three_d] voxel_m = {:g}", side),
                     fmt::format("it is no whole part of the cell of {:g} m", grid.cell),
                     fmt::format("Write {:g}, or another whole part of it",
                                 grid.cell / std::max(1.0, std::ceil(grid.cell / side - 1e-9)))});
  return static_cast<int>(parts);
}

double density_of(const RunSummary& summary, std::int32_t release) {
  const auto r = static_cast<std::size_t>(release);
  return r < summary.release_density.size() ? summary.release_density[r] : summary.density;
}

}  // namespace

Voxels::Voxels(const Run& run, double side)
    : grid_(run.maps.grid),
      bed_(filled_bed(grid_, run.maps.terrain)),
      layer_height_(run.summary.layer_height > 0 ? run.summary.layer_height : grid_.cell),
      division_(division_of(grid_, layer_height_, side)) {
  side_ = grid_.cell / division_;
  const double lowest = *std::min_element(bed_.begin(), bed_.end());
  origin_ = {grid_.west, grid_.south, std::floor(lowest / side_) * side_};
}

double Voxels::bed_at(double x, double y) const {
  double bed = 0;
  share_among_cells(grid_, x, y, [&](std::size_t cell, double weight) { bed += weight * bed_[cell]; });
  return bed;
}

std::unordered_map<std::size_t, Voxels::Column> Voxels::nodes_of(const Run& run, const PointFrame& points) const {
  std::unordered_map<std::size_t, Column> columns;
  for (std::size_t p = 0; p < points.position.size(); ++p) {
    const auto& [x, y, z] = points.position[p];
    const double mass = points.volume[p] * density_of(run.summary, points.release[p]);
    const double height = std::max(0.0, z - bed_at(x, y)) / layer_height_;
    const auto layer = static_cast<std::size_t>(height);
    const double above = height - static_cast<double>(layer);
    share_among_cells(grid_, x, y, [&](std::size_t cell, double weight) {
      Column& column = columns[cell];
      if (column.size() < layer + 2) column.resize(layer + 2, Node{});
      for (const std::size_t k : {layer, layer + 1}) {
        const double part = mass * weight * (k == layer ? 1 - above : above);
        column[k][0] += part;
        for (std::size_t a = 0; a < 3; ++a) column[k][a + 1] += part * points.velocity[p][a];
      }
    });
  }
  return columns;
}

/// One of the division() x division() parts of a column: a node's cell reaches half a layer up and down, that of the
/// base node up alone.
void Voxels::add_part(const std::array<int, 2>& place, double bed, const Column& column, VolumeFile& volume) const {
  const double low = (bed - origin_[2]) / side_, layer = layer_height_ / side_;
  const auto edge = [&](std::size_t k) { return k == 0 ? low : low + (static_cast<double>(k) - 0.5) * layer; };
  const int first = static_cast<int>(std::floor(low));
  std::vector<Node> voxels(static_cast<std::size_t>(std::floor(edge(column.size())) - first + 1), Node{});
  const double parts = 1.0 / (division_ * division_);
  for (std::size_t k = 0; k < column.size(); ++k) {
    if (!(column[k][0] > 0)) continue;
    const double from = edge(k), to = edge(k + 1);
    for (int v = static_cast<int>(std::floor(from)); v < to; ++v) {
      const double share = parts * (std::min(to, v + 1.0) - std::max(from, static_cast<double>(v))) / (to - from);
      for (std::size_t a = 0; a < 4; ++a) voxels[static_cast<std::size_t>(v - first)][a] += share * column[k][a];
    }
  }
  for (std::size_t v = 0; v < voxels.size(); ++v) {
    const Node& sum = voxels[v];
    if (!(sum[0] > 0)) continue;
    volume.voxels.push_back({place[0], place[1], first + static_cast<int>(v)});
    volume.density.push_back(static_cast<float>(sum[0] / (side_ * side_ * side_)));
    volume.velocity.push_back({static_cast<float>(sum[1] / sum[0]), static_cast<float>(sum[2] / sum[0]),
                               static_cast<float>(sum[3] / sum[0])});
  }
}

void Voxels::add_column(std::size_t cell, const Column& column, VolumeFile& volume) const {
  const auto columns = static_cast<std::size_t>(grid_.columns);
  const int first_i = static_cast<int>(cell % columns) * division_,
            first_j = static_cast<int>(cell / columns) * division_;
  for (int j = first_j; j < first_j + division_; ++j)
    for (int i = first_i; i < first_i + division_; ++i)
      add_part({i, j}, bed_at(grid_.west + (i + 0.5) * side_, grid_.south + (j + 0.5) * side_), column, volume);
}

VolumeFile Voxels::volume(const Run& run, const PointFrame& points) const {
  VolumeFile volume{.time = points.time,
                    .run_id = fact(run.summary.provenance, run_id),
                    .crs = crs_name(grid_.crs_wkt),
                    .origin = origin_,
                    .side = side_};
  for (const auto& [cell, column] : nodes_of(run, points)) add_column(cell, column, volume);
  return volume;
}

}  // namespace talus::postprocess
