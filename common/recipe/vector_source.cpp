// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/vector_source.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace talus {
namespace {

constexpr std::string_view layer_mark = "|layername=", where_mark = "|subset=";

}  // namespace

std::filesystem::path VectorSource::text() const {
  std::string all = file.string();
  if (!layer.empty()) all.append(layer_mark).append(layer);
  if (!where.empty()) all.append(where_mark).append(where);
  return all;
}

VectorSource vector_source(const std::filesystem::path& text) {
  std::string all = text.string();
  VectorSource source;
  const std::size_t layer = all.find(layer_mark), where = all.find(where_mark);
  if (where != std::string::npos) source.where = all.substr(where + where_mark.size());
  all.resize(std::min(where, all.size()));
  if (layer < where) source.layer = all.substr(layer + layer_mark.size());
  all.resize(std::min(layer, all.size()));
  source.file = std::move(all);
  return source;
}

}  // namespace talus
