// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/domain_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace talus {
namespace {

constexpr auto plain_letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

/// A finite number at `at`, which moves behind it.
std::optional<double> number_at(const char*& at, const char* end) {
  double value = 0;
  const auto [next, error] = std::from_chars(at, end, value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  at = next;
  return value;
}

}  // namespace

bool is_plain_name(const std::string& name) {
  return !name.empty() && name.find_first_not_of(plain_letters) == std::string::npos;
}

std::string plain_name(const std::string& name) {
  std::string plain;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t other = std::min(name.find_first_not_of(plain_letters, at), name.size());
    plain += name.substr(at, other - at);
    at = std::min(name.find_first_of(plain_letters, other), name.size());
    if (!plain.empty() && other < name.size() && at < name.size()) plain += '-';
  }
  return plain;
}

std::string text_of_points(const MapLine& points) {
  std::string text;
  for (const auto& [x, y] : points) text += fmt::format("{}{},{}", text.empty() ? "" : " ", x, y);
  return text;
}

std::optional<MapLine> points_in(const std::string& text) {
  MapLine points;
  const char *at = text.data(), *const end = text.data() + text.size();
  while (at != end) {
    if (!points.empty() && *at++ != ' ') return std::nullopt;
    const auto x = number_at(at, end);
    if (!x || at == end || *at++ != ',') return std::nullopt;
    const auto y = number_at(at, end);
    if (!y) return std::nullopt;
    points.push_back({*x, *y});
  }
  if (points.empty()) return std::nullopt;
  return points;
}

}  // namespace talus
