// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// domain.vdb: what talus-preprocess hands to talus-solve.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/domain/active_cells.hpp"
#include "common/domain/domain_place.hpp"
#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"

namespace talus {

/// Material points as seeded: positions in map coordinates, height measured from the bed.
struct SeedPoints {
  std::vector<double> x, y;    // map coordinates [m]
  std::vector<double> height;  // above the bed, vertical [m]
  std::vector<double> volume;  // [m3]; the sum is the release's volume to 1e-12
  std::vector<double> extent_x,
      extent_y;              // sides of the box that a point stands for; its height follows from the volume [m]
  std::vector<int> release;  // index into Domain::release_names
  std::size_t size() const { return x.size(); }  ///< number of points
};

/// The scene as the solver sees it. One column of the background grid stands over each map cell.
struct Domain {
  MapGrid grid;
  double layer_height = 0;   // h_z, vertical spacing of the background grid [m]
  Raster terrain;            // bed under the release, ground elsewhere [m]; NaN outside the domain
  Raster before;             // surface before the failure [m]
  Raster release_thickness;  // vertical [m], 0 where nothing is released
  std::vector<std::pair<std::string, Raster>>
      bed;  // numbers of the bed's friction by the names of [solve.base]; NaN: the recipe's
  std::vector<std::string> release_names;
  int erodible = 0;  // of these, the first so many lie in the ground until something takes them along
  SeedPoints points;
  std::vector<DomainPlace> places;    // lines and points that [solve] asks for by name
  std::vector<MapPlace> obstacles;    // where those of obstacles.vdb stand
  std::optional<ActiveCells> active;  // the mask of the file it was read from; none where it was made in memory
  std::vector<std::pair<std::string, std::string>> provenance;  // version, command, inputs and checksums
  std::vector<Finding> findings;                                // of talus-preprocess
};

/// Write `file` (aside, renamed): PointDataGrid "points" (attributes volume, height, extent_x, extent_y, release),
/// DoubleGrids "terrain", "before", "release_thickness", and "bed.NAME" for rasters of the bed, one voxel thick,
/// MaskGrid "inside" of the map cells inside the domain, one voxel thick too, MaskGrid "active" of the cells of the
/// background grid around the points (active_cells.hpp); grid, CRS, units, places and provenance as metadata. Throws
/// DataError (disk full, not writable).
void write_domain(const std::filesystem::path& file, const Domain& domain);

/// Read it back. Coordinates keep 1e-6 of a cell, volumes and heights are exact. Throws DataError: missing, damaged,
/// not a domain of this program, a mask "active" of another grid or not of whole blocks, numbers that cannot be.
Domain read_domain(const std::filesystem::path& file);

/// The provenance of a domain: the head of the file alone is read, its seal checked. Throws as read_domain() does.
Facts domain_facts(const std::filesystem::path& file);

/// The vertical thickness of the erodible layers in each cell [m], by the volumes of their points.
std::vector<double> erodible_thickness(const Domain& domain);

/// This function multiplies the vertical thickness of what is released by `factor` > 0: release_thickness, the volumes
/// of the released points and their heights above the ground that they lie on (the bed, or the erodible layers under
/// them). The bed stays, and so does the outline; the surface before the failure follows the thickness. Erodible
/// ground stays as it is, and the mask of active cells is dropped, since points may stand in other layers. Layers of
/// points are stretched: as many points stand for more or less height, while talus-preprocess would seed others. Throws
/// std::logic_error for a factor that is not positive.
void scale_release(Domain& domain, double factor);

}  // namespace talus
