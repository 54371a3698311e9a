// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the things that have columns of the history.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

/// This function declares that every item of [[solve.TABLE]] has a name of its own that is fit for the names of
/// columns. `why` says what the names are for. An item without one takes the names that a place of the domain has.
void need_names(recipe::Visitor& v, const std::string& table, const std::string& why,
                const std::vector<std::optional<std::string>>& names);
/// This function declares the same of items with a member `name`.
template <class Item>
void need_names(recipe::Visitor& v, const std::string& table, const std::string& why, const std::vector<Item>& items) {
  std::vector<std::optional<std::string>> names;
  names.reserve(items.size());
  for (const Item& item : items) {
    names.push_back(item.name);
    if constexpr (requires { item.place; }) {
      if (item.name.empty() && !item.place.empty()) names.back().reset();
    }
  }
  need_names(v, table, why, names);
}

}  // namespace talus::solver
