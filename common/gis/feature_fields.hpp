// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Attributes of a vector file, apart from its shapes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// An attribute that is set to a text which is no number.
struct TextField {
  long long feature = 0;  ///< its number in the layer, from 1
  std::string field, text;
};

/// The fields of a vector source, in their order. Throws DataError when it cannot be read.
std::vector<std::string> field_names(const std::filesystem::path& source);

/// The attributes whose names `wanted` takes for numbers, and which are set to something else. Throws DataError when
/// the source cannot be read.
std::vector<TextField> text_fields(const std::filesystem::path& source,
                                   const std::function<bool(std::string_view)>& wanted);

}  // namespace talus
