// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/paths.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "common/error.hpp"
#include "common/text_encoding.hpp"

namespace talus {
namespace {

thread_local ShownPaths* shown_here = nullptr;

bool of_a_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-' || c == '/' ||
         static_cast<unsigned char>(c) >= 0x80;
}

/// True where `path` stands in `text` at `at` as whole names.
bool stands_at(std::string_view text, std::size_t at, std::string_view path) {
  if (text.substr(at, path.size()) != path) return false;
  const std::size_t end = at + path.size();
  // A full stop ends a sentence more often than it begins the rest of a name.
  return end == text.size() || text[end] == '/' || !of_a_name(text[end]) ||
         (text[end] == '.' && (end + 1 == text.size() || text[end + 1] == ' '));
}

/// What no name of a path holds, for the end of one that stands in a text.
bool ends_path(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("\"',;()[]<>|").find(c) != std::string_view::npos;
}

constexpr std::string_view layer_mark = "|layername=", where_mark = "|subset=";

}  // namespace

void ShownPaths::show_as(const std::filesystem::path& path, const std::string& shown, const std::string& in_report) {
  std::string plain = path.lexically_normal().string();
  while (plain.size() > 1 && plain.back() == '/') plain.pop_back();
  if (plain.size() < 2 || plain.front() != '/') return;
  const std::lock_guard lock(mutex_);
  std::erase_if(known_, [&](const Shown& one) { return one.path == plain; });
  const auto shorter = [&](const Shown& one) { return one.path.size() < plain.size(); };
  known_.insert(std::find_if(known_.begin(), known_.end(), shorter), {plain, shown, in_report});
}

std::string ShownPaths::replaced(const std::string& text, std::string Shown::*shown) const {
  const std::lock_guard lock(mutex_);
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const bool begins = text[at] == '/' && (at == 0 || !of_a_name(text[at - 1]));
    const auto found = !begins ? known_.end() : std::find_if(known_.begin(), known_.end(), [&](const Shown& one) {
      return stands_at(text, at, one.path);
    });
    if (found == known_.end()) {
      result += text[at++];
      continue;
    }
    at += found->path.size();
    const std::string& name = (*found).*shown;
    const bool below = at < text.size() && text[at] == '/';
    if (name.empty() && below) ++at;
    result += name.empty() && !below ? "." : name;
  }
  return result;
}

std::string ShownPaths::in_message(const std::string& text) const { return replaced(text, &Shown::message); }
std::string ShownPaths::in_report(const std::string& text) const { return replaced(text, &Shown::report); }

ShownPaths& shown_paths_of_other_threads() {
  static ShownPaths* const shared = new ShownPaths;
  return *shared;
}

ShownPaths& shown_paths() { return shown_here != nullptr ? *shown_here : shown_paths_of_other_threads(); }

BindShownPaths::BindShownPaths(ShownPaths& paths) : previous_(std::exchange(shown_here, &paths)) {}
BindShownPaths::~BindShownPaths() { shown_here = previous_; }

void show_path_as(const std::filesystem::path& path, const std::string& shown, const std::string& in_report) {
  shown_paths().show_as(path, shown, in_report);
}

std::string with_shown_paths(const std::string& text) { return shown_paths().in_message(text); }

std::string without_absolute_paths(const std::string& text) {
  const std::string relative = shown_paths().in_report(text);
  std::string result;
  for (std::size_t at = 0; at < relative.size();) {
    const char before = at == 0 ? ' ' : relative[at - 1];
    const bool begins = relative[at] == '/' && (ends_path(before) || before == '=' || before == ':') &&
                        at + 1 < relative.size() && relative[at + 1] != '/' && !ends_path(relative[at + 1]);
    if (!begins) {
      result += relative[at++];
      continue;
    }
    std::size_t end = at;
    while (end < relative.size() && !ends_path(relative[end])) ++end;
    std::string path = relative.substr(at, end - at);
    while (path.size() > 1 && path.back() == '/') path.pop_back();
    result += "\u2026" + path.substr(path.rfind('/'));
    at = end;
  }
  return result;
}

void refuse_name_beyond_utf8(const std::filesystem::path& path) {
  if (is_utf8(path.string())) return;
  throw RecipeError({as_utf8(path.string()) + ": the name of this file or of a folder above it is not UTF-8",
                     "results record it, and other programs could not read them",
                     "Rename it: convmv -f cp1252 -t utf8 --notest NAME, or mv"});
}

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
