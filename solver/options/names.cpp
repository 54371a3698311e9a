// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/options/names.hpp"

#include <fmt/format.h>

#include "common/domain/domain_place.hpp"

namespace talus::solver {

void need_names(recipe::Visitor& v, const std::string& table, const std::string& why,
                const std::vector<std::optional<std::string>>& names) {
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (!names[n]) continue;
    const std::string& name = *names[n];
    const bool plain = is_plain_name(name);
    v.needs(plain, {fmt::format("[[solve.{}]] number {}: name = \"{}\"", table, n + 1, name), why,
                    "Give it one of letters, digits, - and _"});
    for (std::size_t earlier = 0; earlier < n; ++earlier) {
      v.needs(!plain || names[earlier] != name,
              {fmt::format("[[solve.{}]] name = \"{}\" is given twice", table, name), why, "Rename one"});
    }
  }
}

}  // namespace talus::solver
