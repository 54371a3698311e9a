// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and points as VTK's XML files, for ParaView 5.11 and newer: VTK File Formats (Kitware), "XML File Formats",
// appended raw data in blocks of zlib, byte order of the machine.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace talus::postprocess {

/// Values of an array of VTK, flat: `components` numbers for each point or cell.
using VtkValues =
    std::variant<std::vector<float>, std::vector<double>, std::vector<std::int32_t>, std::vector<std::int64_t>>;

/// A named array on points or cells.
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

/// Lengths to 1/1024 m: the low bits of coordinates are zero, and zlib has less to pack.
double to_a_millimetre(double metres);

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

}  // namespace talus::postprocess
