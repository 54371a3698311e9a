// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a stage's results are made of, as rules for make.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace talus {

struct Dependencies {
  std::vector<std::filesystem::path> results;  ///< files that the stage writes; the last one written stands first
  std::vector<std::filesystem::path> inputs;   ///< files that it reads besides the recipe, which --used stands for
};

/// A rule of GNU make, "results: inputs", and an empty rule for every input (as compilers write with -MP), so that a
/// file that is missing is no fault of the rules. Each input is listed once. Names that make has no way to write (with
/// ';' or a line break in them, or ')', '&' or '\' at their end) become comments.
std::string make_rules(const Dependencies& depends);

}  // namespace talus
