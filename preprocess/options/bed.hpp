// Rasters of the bed's friction.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/domain/bed_numbers.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// The keys of [preprocess.bed]: rasters under the names of the numbers in [solve.base] that they take the place of.
struct BedRasters {
  std::vector<std::pair<std::string, std::filesystem::path>> files;

  BedRasters() {
    for (const std::string_view key : bed_numbers) files.emplace_back(key, std::filesystem::path());
  }
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v) {
    for (auto& [name, file] : files)
      v.path(name, file, "raster that takes the place of [solve.base] " + name + "; no data: that number");
  }
};

}  // namespace talus::preprocess
