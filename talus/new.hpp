// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus new: a commented recipe from the elevation models before and after a slide.
#pragma once

#include <filesystem>
#include <string>

namespace talus::command {

struct NewScene {
  std::filesystem::path before, after;
  std::filesystem::path recipe;  ///< to be written
  bool overwrite = false;
};

/// Compares the two models, proposes spacing, layers, friction and end time from what failed, and writes the recipe. It
/// asks nothing. Returns 0. Throws DataError where the two models show no slide, with what talus-preprocess says of
/// them, and where the recipe is there already.
int new_scene(const NewScene& scene);

}  // namespace talus::command
