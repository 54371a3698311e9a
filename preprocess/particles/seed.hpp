// Material points in the released mass: cell by cell, a column of the release's thickness at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "common/domain/domain.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/release/releases.hpp"

namespace talus::preprocess {

/// How densely to seed; see GridOptions.
struct Seeding {
  int along_x = 2, along_y = 2, in_height = 2;  // points per cell of the background grid
  double layer_height = 0;                      // h_z [m]
  double minimum_thickness = 0;                 // thinner columns get one point [m]
  double jitter = 0;                            // 0..0.5 of the points' spacing
  std::uint64_t jitter_seed = 1;
};

/// Seeding as the recipe says, with its defaults resolved for cells of `spacing`.
Seeding seeding_of(const GridOptions& options, double spacing);

/// Points for all releases, without making them.
std::size_t count_points(const std::vector<Release>& releases, const Seeding& seeding);

/// A column of vertical thickness T over a cell of side h gets n_x n_y n_z points of volume T h^2 / (n_x n_y n_z) each,
/// n_z = max(1, round(T / h_z * in_height)), evenly spaced: so the volumes sum to that of the rasters to rounding,
/// whatever the points per cell. Releases in one cell lie on one another, the first lowest.
SeedPoints seed_points(const std::vector<Release>& releases, const Seeding& seeding);

}  // namespace talus::preprocess
