// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// OUT/3d: a run for ParaView 5.11 and newer, as meshes and points over time in VTK's XML files: VTK File Formats
// (Kitware), "XML File Formats", appended raw data in blocks of zlib, byte order of the machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/run/point_frames.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/options/writer.hpp"

namespace talus::postprocess {

/// Values of an array of VTK, flat: `components` numbers for each point or cell.
using VtkValues =
    std::variant<std::vector<float>, std::vector<double>, std::vector<std::int32_t>, std::vector<std::int64_t>>;

struct VtkArray {
  std::string name;  ///< with its unit: "thickness_m"
  VtkValues values;
  int components = 1;
};

/// What a PolyData file holds: points, and either vertices (one a point) or quadrilaterals of four points each.
struct VtkMesh {
  std::vector<std::array<double, 3>> points;       ///< map coordinates and elevation [m]
  std::vector<std::array<std::int64_t, 4>> quads;  ///< anticlockwise as seen from above; empty: a vertex for each point
  std::vector<VtkArray> on_points;
  std::vector<std::pair<std::string, std::string>> facts;  ///< words about the whole ("crs"): FieldData
};

/// Writes `mesh` as PolyData (.vtp), aside and renamed. Points are rounded to 1/1024 m. Throws DataError where it
/// cannot be written, std::logic_error where arrays and points differ in length.
void write_vtp(const std::filesystem::path& file, const VtkMesh& mesh);

/// A file that a collection shows at a time, as part `part` of what is shown then.
struct VtkPart {
  double time;  ///< [s]
  int part;
  std::string file;  ///< relative to the collection
};

/// Writes a ParaView collection (.pvd), aside and renamed. Throws DataError.
void write_pvd(const std::filesystem::path& file, const std::vector<VtkPart>& parts);

/// Thickness below which the surface of the flow is not drawn [m]. A rim of cells beyond it is part of the mesh.
inline constexpr double thinnest_surface = 1e-3;

/// The bed with the run's maps as arrays, named as GeoTIFFs; a vertex at each centre of a cell inside the domain.
VtkMesh terrain_mesh(const RunMaps& maps);

/// The surface of the flow at a frame: a vertex at each centre of a cell that the flow covers and of those around them,
/// at bed + thickness; arrays "thickness" [m] (vertical), "bed" [m] and, where points are given, "velocity" [m/s]: the
/// mean over the column by volume. Under the mesh, triangulated along either diagonal, lies the volume of the map.
VtkMesh surface_mesh(const Run& run, std::size_t frame, const std::optional<PointFrame>& points);

/// The material points: arrays "velocity" [m/s], "volume" [m3], "pressure" [Pa], "id", "release".
VtkMesh point_mesh(const PointFrame& frame);

/// Means over the columns of the points' velocity by volume [m/s], a row of three for each cell: each point counts for
/// the four cell centres around it by its distance (bilinear); 0 where no point is near.
std::vector<float> column_velocity(const MapGrid& grid, const PointFrame& points);

/// Contents of OUT/3d.
struct ThreeDParts {
  bool surface = true;  ///< of the flow over time, as a mesh
  bool terrain = true;  ///< with the maps on it
  bool points = false;  ///< material points over time

  bool any() const { return surface || terrain || points; }
};

/// Estimated size of OUT/3d [MB of 1e6 bytes], from the packed size of points and cells in measured runs.
struct ThreeDSize {
  double surface = 0, terrain = 0, points = 0;
  double all() const { return surface + terrain + points; }
};

ThreeDSize size_of_three_d(const ThreeDParts& options, const Run& run, const PointFrames& points);

/// Logs the estimate. Throws DataError if it exceeds `most` [MB], or points are wanted of a run without point frames.
void check_three_d(const ThreeDParts& options, const Run& run, const PointFrames& points, double most = 4000);

/// Writes the wanted files into `folder`, made where it is missing: terrain.vtp, surface.pvd, points.pvd, and run.pvd
/// with all of them. Returns the files to open. Throws DataError, Interrupted.
Files write_three_d(const std::filesystem::path& folder, const ThreeDParts& options, const Run& run,
                    const PointFrames& points);

}  // namespace talus::postprocess
