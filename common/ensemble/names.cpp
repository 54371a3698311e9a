// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/names.hpp"

#include <algorithm>
#include <regex>
#include <utility>

#include <fmt/format.h>

namespace talus {

std::filesystem::path EnsemblePaths::domain(std::int64_t member) const {
  return folder() / fmt::format("domain.{:05}.vdb", member);
}

std::filesystem::path EnsemblePaths::counts(const MemberRange& part) const {
  return out / fmt::format("counts.{}-{}.h5", part.first, part.end);
}

std::filesystem::path EnsemblePaths::unfinished(const MemberRange& part) const {
  return out / fmt::format("unfinished.{}-{}.h5", part.first, part.end);
}

std::filesystem::path EnsemblePaths::run_folder(std::int64_t member) const {
  return folder() / fmt::format("{:05}", member);
}

std::vector<std::filesystem::path> EnsemblePaths::found_counts() const {
  if (std::filesystem::exists(counts())) return {counts()};
  static const std::regex of_a_part(R"(counts\.([0-9]{1,18})-[0-9]{1,18}\.h5)");
  std::vector<std::pair<std::int64_t, std::filesystem::path>> parts;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(out, unreadable)) {
    std::smatch match;
    const std::string name = entry.path().filename().string();
    if (std::regex_match(name, match, of_a_part)) parts.emplace_back(std::stoll(match[1]), entry.path());
  }
  std::sort(parts.begin(), parts.end());
  std::vector<std::filesystem::path> files;
  for (auto& [first, file] : parts) files.push_back(std::move(file));
  return files;
}

}  // namespace talus
