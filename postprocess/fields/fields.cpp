// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/fields/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace talus::postprocess {

std::vector<MapField> product_fields(const RunMaps& maps) {
  std::vector<MapField> products;
  for (const MapField& field : map_fields) {
    if (!std::string_view(field.product.legend).empty() && !(maps.*(field.values)).empty()) products.push_back(field);
  }
  return products;
}

const MapField& map_field(std::string_view name) {
  for (const MapField& field : map_fields) {
    if (name == field.name) return field;
  }
  throw std::logic_error("there is no map " + std::string(name));
}

std::vector<char> inside_domain(const RunMaps& maps) {
  std::vector<char> inside(maps.grid.count());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    inside[i] = std::isfinite(maps.terrain[i]) || maps.deposit_thickness[i] > 0 || maps.peak_thickness[i] > 0;
  }
  return inside;
}

Raster field_raster(const RunMaps& maps, const MapField& field) {
  return values_raster(maps, maps.*(field.values), field.product.zero_inside);
}

Raster values_raster(const RunMaps& maps, const std::vector<double>& values, bool zero_inside) {
  Raster raster{maps.grid, values};
  const auto inside = inside_domain(maps);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!inside[i])
      raster.values[i] = std::numeric_limits<double>::quiet_NaN();
    else if (zero_inside && std::isnan(raster.values[i]))
      raster.values[i] = 0;
  }
  return raster;
}

std::vector<std::string> file_words(const std::vector<std::pair<std::string, std::vector<double>>>& named) {
  std::vector<std::string> words;
  const auto taken = [&](const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  for (const auto& [name, values] : named) {
    const std::string plain = file_word(name);
    std::string word = plain;
    for (int k = 2; taken(word); ++k) word = fmt::format("{}-{}", plain, k);
    words.push_back(word);
  }
  return words;
}

std::string file_word(const std::string& name) {
  std::string word = name;
  for (char& c : word) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
    if (!plain) c = '-';
  }
  return word;
}

std::string csv_field(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

double volume_under(const std::vector<double>& thickness, double cell) {
  long double sum = 0;
  for (const double h : thickness) {
    if (std::isfinite(h)) sum += h;
  }
  return static_cast<double>(sum * static_cast<long double>(cell) * static_cast<long double>(cell));
}

}  // namespace talus::postprocess
