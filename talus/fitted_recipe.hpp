// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// fitted.toml: a scene's recipe with the values that a fit or a calibration found best.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "talus/commands.hpp"

namespace talus::command {

class FittedRecipe {
 public:
  /// `command`: "talus fit". Throws DataError where a person wrote a fitted.toml beside the recipe.
  FittedRecipe(const Request& request, std::string command);

  /// Writes the recipe with these values ("key=value") below comment lines that say where they come from; the file.
  std::filesystem::path write(std::vector<std::string> set, const std::vector<std::string>& lines) const;

  const std::filesystem::path& file() const { return file_; }

 private:
  const Request& request_;
  std::string command_;
  std::filesystem::path file_;
};

}  // namespace talus::command
