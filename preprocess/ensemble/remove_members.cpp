// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <regex>

#include "common/stage/stage.hpp"
#include "preprocess/ensemble/ensemble.hpp"

namespace talus::preprocess {

namespace fs = std::filesystem;

void remove_members(const EnsemblePaths& paths, const EnsemblePlan* plan) {
  remove_for_good(paths.members());
  static const std::regex of_a_member(R"(domain\.([0-9]{5,7})\.vdb)");
  std::vector<fs::path> gone;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(paths.folder(), unreadable)) {
    std::smatch match;
    const std::string name = entry.path().filename().string();
    if (!std::regex_match(name, match, of_a_member)) continue;
    const std::size_t member = std::stoul(match[1]);
    const bool wanted = plan != nullptr && member < plan->table.own_domain.size() && plan->table.own_domain[member];
    if (!wanted) gone.push_back(entry.path());
  }
  for (const fs::path& file : gone) remove_for_good(file);
}

}  // namespace talus::preprocess
