// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of vector files in one text, as QGIS shows them.
#pragma once

#include <filesystem>
#include <string>

namespace talus {

/// "slides.gpkg|layername=release|subset=id = 12"; layer and condition may be left out.
struct VectorSource {
  std::filesystem::path file;
  std::string layer = {};  ///< of the file; empty: not named
  std::string where = {};  ///< condition on attributes, as OGR takes it (`"fid" = 12`); empty: all features

  /// The text of it.
  std::filesystem::path text() const;
};

/// The parts of such a text. That of any other path is a file alone.
VectorSource vector_source(const std::filesystem::path& text);

}  // namespace talus
