// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A case's recipe with some keys overridden: how the driver makes the variants of a case.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace talus::validation {

using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<std::int64_t>, std::vector<double>>;

/// Key and value: "solve.implicit.step_s", "preprocess.grid.spacing_m". Tables that are missing are made; the index one
/// past the end of an array of tables adds a table.
using Overrides = std::vector<std::pair<std::string, Value>>;

inline Value words(std::string text) { return Value(std::move(text)); }
inline Value whole(long number) { return Value(static_cast<std::int64_t>(number)); }

/// Text of the recipe `base` with the overrides. Throws std::runtime_error: no file, no TOML, a key that leads nowhere.
std::string recipe_with(const std::filesystem::path& base, const Overrides& overrides);

/// a, then b.
Overrides operator+(Overrides a, const Overrides& b);

/// Cells of a size [m], with so many points along each side, on ground whose nodes lie at the planes of its walls.
inline Overrides grid_of(double h, int per_cell) {
  return {{"preprocess.grid.spacing_m", h},
          {"preprocess.grid.points_per_cell", std::vector<std::int64_t>(3, per_cell)},
          {"preprocess.laboratory.corner_m[0]", -3.5 * h},
          {"preprocess.laboratory.corner_m[1]", -3.5 * h}};
}

}  // namespace talus::validation
