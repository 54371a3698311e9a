// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/dataset_name.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace talus {
namespace fs = std::filesystem;
namespace {

/// File systems of GDAL that lie over a file of this machine. Of those marked the path stands behind this sign or word.
struct FileSystem {
  std::string_view prefix, mark;
};
constexpr std::array<FileSystem, 8> file_systems{{{"/vsizip/", ""},
                                                  {"/vsigzip/", ""},
                                                  {"/vsitar/", ""},
                                                  {"/vsi7z/", ""},
                                                  {"/vsirar/", ""},
                                                  {"/vsisubfile/", ","},
                                                  {"/vsisparse/", ""},
                                                  {"/vsicrypt/", "file="}}};

bool is_word(std::string_view text) {
  return text.size() > 1 && std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

bool is_upper_word(std::string_view text) {
  return is_word(text) && std::ranges::none_of(text, [](unsigned char c) { return std::islower(c); });
}

/// The file at a path, or that one on the way to it which is a file; the path itself where there is none.
fs::path file_on_way(const fs::path& whole) {
  std::error_code unknown;
  for (fs::path file = whole; file.has_relative_path(); file = file.parent_path())
    if (fs::exists(file, unknown)) return fs::is_directory(file, unknown) ? whole : file;
  return whole;
}

std::optional<DatasetName> in_file_system(std::string before, std::string_view rest, const std::string& after);

/// A path that may be a name of a file system itself.
std::optional<DatasetName> nested(std::string before, std::string_view rest, const std::string& after) {
  if (rest.starts_with("vsi") && rest.find('/') != std::string_view::npos)  // /vsizip/vsigzip/...
    return in_file_system(std::move(before), "/" + std::string(rest), after);
  if (rest.starts_with("/vsi")) return in_file_system(std::move(before), rest, after);
  if (rest.empty() || holds_address(rest)) return std::nullopt;
  return DatasetName{std::move(before), std::string(rest), after};
}

std::optional<DatasetName> in_file_system(std::string before, std::string_view rest, const std::string& after) {
  const auto found = std::ranges::find_if(file_systems, [&](const auto& one) { return rest.starts_with(one.prefix); });
  if (found == file_systems.end()) return std::nullopt;
  std::size_t at = found->prefix.size();
  if (const std::size_t mark = rest.find(found->mark, at); mark != std::string_view::npos)
    at = mark + found->mark.size();
  std::size_t end = rest.size();
  if (rest.substr(at).starts_with('{')) {
    end = std::min(rest.rfind('}'), rest.size());
    ++at;
  }
  if (end < at) return std::nullopt;
  return nested(before.append(rest.substr(0, at)), rest.substr(at, end - at), std::string(rest.substr(end)) + after);
}

/// The path among words parted by colons, from `at` on; none of them may be quoted.
std::optional<DatasetName> among_words(const std::string& text, std::size_t at, const fs::path& folder) {
  std::optional<DatasetName> likely;
  for (std::size_t end; at <= text.size(); at = end + 1) {
    end = std::min(text.find(':', at), text.size());
    const std::string word = text.substr(at, end - at);
    const bool number = std::ranges::all_of(word, [](unsigned char c) { return std::isdigit(c); });
    if (number || word.starts_with("//") || word.find('=') != std::string::npos) continue;
    std::optional<DatasetName> name = nested(text.substr(0, at), word, text.substr(end));
    std::error_code unknown;
    if (name && fs::exists(file_on_way(folder / name->path), unknown)) return name;
    if (!likely) likely = std::move(name);
  }
  return likely;
}

}  // namespace

bool holds_address(std::string_view name) {
  constexpr std::string_view mark = "://";
  const auto of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-'; };
  for (std::size_t at = name.find(mark); at != std::string_view::npos; at = name.find(mark, at + 1)) {
    std::size_t start = at;
    while (start > 0 && of_word(name[start - 1])) --start;
    if (start < at && (start == 0 || name[start - 1] != '.')) return true;
  }
  return false;
}

std::string DatasetName::from(const fs::path& folder) const {
  return before + (folder / path).lexically_normal().string() + after;
}

std::optional<DatasetName> dataset_name(const std::string& text, const fs::path& folder) {
  if (holds_address(text)) return std::nullopt;
  if (text.starts_with("/vsi")) return in_file_system("", text, "");
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return std::nullopt;
  const std::string_view driver = std::string_view(text).substr(0, colon);
  const std::size_t quote = text.find('"', colon), end = quote == std::string::npos ? quote : text.find('"', quote + 1);
  if (is_word(driver) && end != std::string::npos)
    return nested(text.substr(0, quote + 1), std::string_view(text).substr(quote + 1, end - quote - 1),
                  text.substr(end));
  return is_upper_word(driver) ? among_words(text, colon + 1, folder) : std::nullopt;
}

fs::path file_behind(const fs::path& name) {
  const auto parts = dataset_name(name.string());
  return parts ? file_on_way(parts->path) : name;
}

}  // namespace talus
