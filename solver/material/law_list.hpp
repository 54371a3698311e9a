// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A list of laws, and how the one that is meant at run time is found in it: by comparisons that are inlined into the
// kernel, without virtual calls or pointers to functions.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "solver/parallel/macros.hpp"

namespace talus {

/// The laws of a kind, in the order in which recipes list them; a law is a type with static members alone.
template <class... Laws>
struct LawList {
  static constexpr int count = sizeof...(Laws);

  /// The number of `Law` in the list; the call does not compile where the list lacks it.
  template <class Law>
  static constexpr int index_of() {
    static_assert((std::is_same_v<Law, Laws> || ...), "the law is not in the list");
    int index = 0;
    (void)((std::is_same_v<Law, Laws> ? true : (++index, false)) || ...);
    return index;
  }

  /// This function calls visit(Law{}) for every law of the list, in its order.
  template <class Visit>
  static void each(const Visit& visit) {
    (visit(Laws{}), ...);
  }

  /// The names of the laws as recipes write them.
  static std::vector<std::string_view> names() { return {Laws::name...}; }
};

/// The list of the laws that X-macros give behind their first argument, which is void.
template <class, class... Laws>
using LawListBehind = LawList<Laws...>;

/// This function returns visit(Law{}) for law number `index` of the list. No law stands in for another: a number that
/// is in no list is a bug that only a cast can make, and the sanitizers stop at it.
template <class First, class... Rest, class Visit>
TALUS_HD auto visit_law(LawList<First, Rest...>, int index, const Visit& visit) {
  if constexpr (sizeof...(Rest) > 0) {
    if (index != 0) return visit_law(LawList<Rest...>{}, index - 1, visit);
  } else {
    if (index != 0) __builtin_unreachable();
  }
  return visit(First{});
}

/// Declares the key that chooses a law of the list by its name; `Model` is an enum whose values number the list.
template <class Laws, class Model>
void choose_law(recipe::Visitor& v, std::string_view key, Model& model, std::string_view help) {
  int index = static_cast<int>(model);
  v.one_of(key, index, Laws::names(), help);
  model = static_cast<Model>(index);
}

/// The table of a recipe that holds the keys of laws.
struct LawTable {
  std::string name;         ///< what messages call it: "[solve.material]"
  std::string_view chosen;  ///< the name of the law that it chooses
};

template <class Laws>
struct OptionsOfLaws;
/// The options of all laws side by side. A recipe names those of every law; only the chosen one's have an effect.
template <class... Laws>
struct OptionsOfLaws<LawList<Laws...>> : Laws::Options... {
  /// The method declares the keys of all laws with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v, const LawTable& shown) { (Laws::Options::describe(v, shown), ...); }
  template <class Law>
  const typename Law::Options& options_of() const {
    return *this;
  }
};

/// The numbers that options describe, by their keys; `table`: what describe() is told besides.
template <class Options, class... Table>
std::map<std::string, double, std::less<>> numbers_of(Options options, const Table&... table) {
  struct Lister final : recipe::Visitor {
    std::map<std::string, double, std::less<>> found;
    void number(std::string_view key, double& value, recipe::Range, std::string_view) override {
      found.emplace(key, value);
    }
  } lister;
  options.describe(lister, table...);
  return std::move(lister.found);
}

/// The keys of numbers that are not their law's own and not at their defaults: they have no effect.
template <class Laws, class Uses>
std::vector<std::string> idle_keys(const OptionsOfLaws<Laws>& options, const Uses& uses) {
  const LawTable unnamed{};
  const auto usual = numbers_of(OptionsOfLaws<Laws>{}, unnamed);
  std::vector<std::string> idle;
  for (const auto& [key, value] : numbers_of(options, unnamed))
    if (value != usual.at(key) && !uses(key)) idle.push_back(key);
  return idle;
}

/// The number in words: as few digits as read back to the same number.
std::string shortest(double value);
/// The number in words, with six significant digits at most.
std::string six_digits(double value);

}  // namespace talus
