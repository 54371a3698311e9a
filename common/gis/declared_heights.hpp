// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What files declare of their heights: the unit of the vertical axis, and the surface from which heights count.
#pragma once

#include <filesystem>
#include <string>

#include "common/stage/identity.hpp"

class OGRSpatialReference;

namespace talus {

/// The vertical axis of a file's CRS: the third of three axes, that of a compound CRS, or that of a vertical CRS alone.
struct DeclaredHeights {
  std::filesystem::path file = {};
  double metres = 0;         ///< in one of the axis's unit; 0: the CRS has no vertical axis, or the file no CRS
  std::string unit = {};     ///< its name, as PROJ has it: "US survey foot"
  bool downwards = false;    ///< the axis counts depths
  std::string datum = {};    ///< "EGM96 geoid", "ellipsoid of World Geodetic System 1984"; "": not declared
  std::string crs_arg = {};  ///< the CRS as an argument of gdalwarp
};

/// The datum and what names it, for the provenance of what is made of a file; none where it declares no datum.
Facts facts_of(const DeclaredHeights& heights);

/// The heights that facts_of() has noted; without a datum where there are none. `file` stands in for the file then.
DeclaredHeights heights_in(const Facts& facts, const std::filesystem::path& file);

/// Refuses, unless accepted ("different-vertical-datums"), elevations of two files that declare different vertical
/// datums. Advises ("undeclared-vertical-datum") where one of them alone declares one. Datums are the same where their
/// names are, but for case, punctuation and the word "ensemble": a geoid has one name in units, versions of a CRS and
/// formats alike, and PROJ gives names of ESRI those of EPSG.
void judge_vertical_datums(const DeclaredHeights& one, const DeclaredHeights& other);

}  // namespace talus

namespace talus::gdal {

/// The vertical axis of a CRS (null: none) of a file. A CRS whose vertical datum has no name, or is called unknown,
/// declares none.
DeclaredHeights declared_heights(const OGRSpatialReference* srs, const std::filesystem::path& file);

}  // namespace talus::gdal
