// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/error.hpp"

namespace talus {
namespace {

constexpr const char* prefix = "place.";
constexpr std::size_t most_letters = 30'000;

std::string text_of(const MapPlace& place, std::size_t stride) {
  std::string text;
  for (const auto& ring : place.rings) {
    if (!text.empty()) text += ";";
    const std::size_t taken = std::max<std::size_t>(1, std::min(stride, ring.size() / 4));  // four corners at least
    for (std::size_t i = 0; i < ring.size(); i += taken)
      text += fmt::format("{}{:.2f},{:.2f}", i == 0 ? "" : " ", ring[i][0], ring[i][1]);
  }
  return text;
}

[[noreturn]] void refuse_place(const std::string& name) {
  throw DataError({"run.h5: the fact \"" + name + "\" names no place", "it was edited or written by another program",
                   "Run talus-solve again"});
}

/// A finite number at `at`, which moves behind it.
double number_at(const char*& at, const std::string& name) {
  char* end = nullptr;
  const double value = std::strtod(at, &end);
  if (end == at || !std::isfinite(value)) refuse_place(name);
  at = end;
  return value;
}

MapPlace read_place(const std::string& name, const std::string& text) {
  MapPlace place{name.substr(std::string(prefix).size()), {{}}};
  for (const char* at = text.c_str(); *at != '\0';) {
    const double x = number_at(at, name);
    if (*at++ != ',') refuse_place(name);
    place.rings.back().push_back({x, number_at(at, name)});
    if (*at == ';') place.rings.emplace_back();
    if ((*at == ';' || *at == ' ') && at[1] != '\0')
      ++at;
    else if (*at != '\0')
      refuse_place(name);
  }
  for (const auto& ring : place.rings)
    if (ring.empty()) refuse_place(name);
  return place;
}

}  // namespace

std::pair<std::string, std::string> place_fact(const MapPlace& place) {
  std::string text = text_of(place, 1);
  for (std::size_t stride = 2; text.size() > most_letters && stride < 1024; stride *= 2) text = text_of(place, stride);
  if (text.size() > most_letters) {  // thousands of polygons: those that fit
    text.resize(most_letters);
    text.resize(std::max<std::size_t>(text.rfind(';'), 1));
  }
  return {prefix + place.words, text};
}

bool is_place(const std::string& name) { return name.starts_with(prefix); }

std::vector<MapPlace> places_in(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::vector<MapPlace> places;
  for (const auto& [name, text] : facts)
    if (is_place(name)) places.push_back(read_place(name, text));
  return places;
}

}  // namespace talus
