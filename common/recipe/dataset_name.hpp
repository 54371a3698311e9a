// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Names of inputs that only GDAL knows, and the path of a file in them. Knows nothing of GDAL.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace talus {

/// A name such as NETCDF:"dem.nc":z, GTIFF_DIR:2:dem.tif, /vsizip/dem.zip/dem.tif or /vsizip/{/vsigzip/a.gz}/dem.tif,
/// cut around the path in it. Behind /vsizip/ and its like a path is absolute where another slash follows.
struct DatasetName {
  std::string before, path, after;

  /// The name with its path, where that is relative, counted from `folder`.
  std::string from(const std::filesystem::path& folder) const;
};

/// The parts of a name. Of several words between colons the path is the one in quotation marks, else the first that is
/// there (relative ones in `folder`), else the first that can be a path. None for a plain path and for what names no
/// file of this machine (/vsicurl/, WMS:, PG:).
std::optional<DatasetName> dataset_name(const std::string& text, const std::filesystem::path& folder = {});

/// True where a name holds an address with a scheme (https://...). HDF5:"dem.h5"://group has none, nor has
/// dem.h5://group: a scheme is a word of its own.
bool holds_address(std::string_view name);

/// The file whose bytes an input is made of: the path in a name that only GDAL knows, of an archive the archive itself;
/// any other name as it is.
std::filesystem::path file_behind(const std::filesystem::path& name);

}  // namespace talus
