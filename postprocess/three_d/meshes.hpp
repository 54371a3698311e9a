// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The ground, the surface of the flow and the material points of a run as meshes.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/run/run_file.hpp"
#include "postprocess/three_d/vtk_file.hpp"

namespace talus::postprocess {

/// Thickness below which the surface of the flow is not drawn [m]. A rim of cells beyond it is part of the mesh.
inline constexpr double thinnest_surface = 1e-3;

/// The bed with the maps of the run as arrays, of the names they have as GeoTIFF; NaN where a map has no value. A
/// vertex at each centre of a cell inside the domain.
VtkMesh terrain_mesh(const RunMaps& maps);

/// The surface of the flow at a frame: a vertex at each centre of a cell that the flow covers and of those around them,
/// at bed + thickness; arrays "thickness" [m] (vertical), "bed" [m] and, where points are given, "velocity" [m/s]: the
/// mean over the column by volume. Under the mesh, triangulated along either diagonal, lies the volume of the map: each
/// vertex stands for a cell.
VtkMesh surface_mesh(const Run& run, std::size_t frame, const std::optional<PointFrame>& points);

/// The material points: arrays "velocity" [m/s], "volume" [m3], "pressure" [Pa], "id", "release".
VtkMesh point_mesh(const PointFrame& frame);

/// Means over the columns of the points' velocity by volume [m/s], a row of three for each cell: each point counts for
/// the four cell centres around it by its distance (bilinear); 0 where no point is near.
std::vector<float> column_velocity(const MapGrid& grid, const PointFrame& points);

}  // namespace talus::postprocess
