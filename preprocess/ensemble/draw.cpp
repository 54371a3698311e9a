// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/draw.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/ensemble/openturns.hpp"
#include "common/error.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/ensemble/csv.hpp"
#include "preprocess/ensemble/marginal.hpp"

namespace talus::preprocess {
namespace {

constexpr std::size_t most_directions = 1111;  // of Sobol's sequence in OpenTURNS
constexpr double most_improved = 2e5;          // members times keys of an optimal hypercube

[[noreturn]] void refuse_design(const std::string& what, const std::string& why, const std::string& mend) {
  throw RecipeError({"[ensemble]: " + what, why, mend});
}

void check_size(Design design, std::size_t members, std::size_t keys) {
  const std::size_t directions = design == Design::sensitivity ? 2 * keys : design == Design::sobol ? keys : 0;
  if (directions > most_directions)
    refuse_design(fmt::format("{} keys vary", keys), fmt::format("Sobol's sequence has {} directions", most_directions),
                  "Vary fewer, or take design = \"latin-hypercube\"");
  if (design == Design::sensitivity && members < 2 * (keys + 2))
    refuse_design(fmt::format("members = {} with design = \"sensitivity\"", members),
                  fmt::format("{} keys need at least {}", keys, 2 * (keys + 2)), "Give more");
  if (design == Design::optimal_hypercube && static_cast<double>(members * keys) > most_improved)
    refuse_design(fmt::format("design = \"optimal-latin-hypercube\" with {} members of {} keys", members, keys),
                  fmt::format("its strata are exchanged one by one; up to {:g} numbers are", most_improved),
                  "Take design = \"sobol\", which fills the space as well");
}

[[noreturn]] void refuse_drawing(const std::string& what, const std::string& why, const std::string& mend) {
  throw RecipeError({"[ensemble] " + what, why, mend});
}

/// What a design that is no random sample leaves no room for.
void check_design(const EnsembleOptions& o) {
  const std::string design = "design = \"" + std::string(design_name(o.design)) + "\"";
  const bool levels = o.design == Design::full_grid || o.design == Design::one_at_a_time;
  if (!o.correlation.empty() && (levels || o.design == Design::sensitivity || o.design == Design::table))
    refuse_drawing(design + " with [[ensemble.correlation]]",
                   o.design == Design::sensitivity ? "shares of the variance are told apart for independent keys only"
                   : levels                        ? "it combines levels without regard to what goes together"
                                                   : "the table gives the values",
                   "Leave the correlations out, or take design = \"sobol\"");
  if (o.elevation_error.acts() && (o.design == Design::one_at_a_time || o.design == Design::sensitivity))
    refuse_drawing(design + " with [ensemble.elevation_error]",
                   "another ground in each member hides what a key does, and has no key whose share could be told",
                   "Leave the error out, or take design = \"sobol\"");
  if (o.design == Design::table && !o.vary.empty())
    refuse_drawing(design + " with [[ensemble.vary]]", "the table says what varies", "Leave one of them out");
  if (o.vary.empty() && (levels || o.design == Design::sensitivity))
    refuse_drawing(design + " without [[ensemble.vary]]", "there is no key to take levels of", "Add one");
}

/// Members times keys of places among levels become values.
void take_levels(MemberTable& table, const std::vector<std::vector<double>>& levels,
                 const std::vector<std::vector<std::size_t>>& members) {
  table.count = static_cast<std::int64_t>(members.size());
  for (std::size_t d = 0; d < levels.size(); ++d)
    for (const auto& member : members) table.columns[d].values.push_back(levels[d].at(member[d]));
}

/// All combinations of one level of each key; the first key changes fastest.
void draw_grid(MemberTable& table, const std::vector<Marginal>& marginals, int count) {
  std::vector<std::vector<double>> levels;
  double all = 1;
  for (const Marginal& marginal : marginals) {
    levels.push_back(marginal.levels(count));
    all *= static_cast<double>(levels.back().size());
  }
  if (all > static_cast<double>(most_members))
    refuse_design(fmt::format("design = \"full-grid\" of {:.3g} members", all),
                  fmt::format("up to {} are run", most_members), "Give fewer levels, or vary fewer keys");
  std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(all));
  for (std::size_t n = 0; n < members.size(); ++n) {
    std::size_t left = n;
    for (const auto& of_key : levels) {
      members[n].push_back(left % of_key.size());
      left /= of_key.size();
    }
  }
  take_levels(table, levels, members);
}

/// The middle of all keys, then each key at its other levels.
void draw_one_at_a_time(MemberTable& table, const std::vector<Marginal>& marginals, int count) {
  std::vector<std::vector<double>> levels;
  for (const Marginal& marginal : marginals) {
    const double middle = marginal.quantile(0.5);
    std::vector<double> of_key = marginal.levels(count);
    const auto is_middle = [&](double value) { return std::abs(value - middle) <= 1e-12 * std::abs(middle); };
    std::erase_if(of_key, is_middle);
    of_key.insert(of_key.begin(), middle);
    levels.push_back(std::move(of_key));
  }
  std::vector<std::vector<std::size_t>> members{std::vector<std::size_t>(levels.size(), 0)};
  for (std::size_t d = 0; d < levels.size(); ++d) {
    for (std::size_t level = 1; level < levels[d].size(); ++level) {
      members.push_back(members.front());
      members.back()[d] = level;
    }
  }
  take_levels(table, levels, members);
}

/// The members of a file whose columns are those of the table, as places in the unit cube.
UnitDesign listed_design(const MemberTable& table, const std::filesystem::path& file) {
  MemberTable listed;
  take_listed(listed, file);
  const auto refuse = [&](const std::string& what) {
    throw DataError({file.string() + ": " + what, "the file gives places in the unit cube of [[ensemble.vary]]",
                     "Give the draws.csv that talus calibrate wrote for this recipe"});
  };
  UnitDesign design;
  design.shares.assign(static_cast<std::size_t>(listed.count), {});
  for (const MemberColumn& column : table.columns) {
    const MemberColumn* const from = listed.find(column.key);
    if (from == nullptr) refuse("it has no column " + column.key);
    for (std::size_t k = 0; k < from->values.size(); ++k) {
      const double share = from->values[k];
      if (!from->words.empty() || !(share > 0 && share < 1))
        refuse(fmt::format("{} of row {} does not lie between 0 and 1", column.key, k + 1));
      design.shares[k].push_back(share);
    }
  }
  return design;
}

void draw_sample(MemberTable& table, const EnsembleOptions& o, const std::vector<Marginal>& marginals) {
  const auto copula = copula_of(o.vary, o.correlation);
  UnitDesign design = o.design == Design::posterior ? listed_design(table, o.table)
                                                    : unit_design(o.design, o.members, marginals.size(), o.seed);
  table.count = static_cast<std::int64_t>(design.shares.size());
  table.sample_size = design.sample_size;
  for (std::vector<double>& shares : design.shares) {
    if (copula != nullptr) copula->bind(shares);
    for (std::size_t d = 0; d < marginals.size(); ++d)
      table.columns[d].values.push_back(marginals[d].quantile(shares[d]));
  }
}

std::string range_of(const MemberColumn& column) {
  if (!column.words.empty()) {
    std::string text;
    for (std::size_t w = 0; w < column.words.size(); ++w)
      text += fmt::format("{}{} in {}", w == 0 ? "" : ", ", column.words[w],
                          std::count(column.values.begin(), column.values.end(), static_cast<double>(w)));
    return text + " members";
  }
  const auto [least, largest] = std::minmax_element(column.values.begin(), column.values.end());
  Sum sum;
  for (const double value : column.values) sum.add(value);
  return fmt::format("{:.6g} to {:.6g}, mean {:.6g}", *least, *largest,
                     sum.value() / static_cast<double>(column.values.size()));
}

}  // namespace

UnitDesign unit_design(Design design, int members, std::size_t keys, int seed) {
  UnitDesign result;
  auto count = static_cast<std::size_t>(members);
  check_size(design, count, keys);
  if (keys == 0) {
    result.shares.resize(count);
    return result;
  }
  if (design == Design::sensitivity) {
    count /= keys + 2;
    result.sample_size = static_cast<std::int64_t>(count);
  }
  result.shares = openturns::library().draw(design, count, keys, static_cast<unsigned long>(seed));
  for (auto& shares : result.shares)
    for (double& share : shares) share = std::clamp(share, 1e-12, 1 - 1e-12);
  return result;
}

MemberTable draw_members(const EnsembleOptions& o) {
  if (!o.is_budget()) check_design(o);
  MemberTable table;
  table.design = design_name(o.design);
  table.seed = o.seed;
  if (o.is_budget()) {
    for (BudgetMember& member : budget_members(o.budget)) {
      table.names.push_back(std::move(member.name));
      table.rows.push_back(std::move(member.row));
    }
    table.count = static_cast<std::int64_t>(table.names.size());
  } else if (o.design == Design::table) {
    take_listed(table, o.table);
  } else {
    std::vector<Marginal> marginals;
    for (const VaryOptions& one : o.vary) {
      marginals.emplace_back(one);
      table.columns.push_back({one.key, {}, marginals.back().words()});
    }
    if (o.design == Design::full_grid)
      draw_grid(table, marginals, o.levels);
    else if (o.design == Design::one_at_a_time)
      draw_one_at_a_time(table, marginals, o.levels);
    else
      draw_sample(table, o, marginals);
  }
  table.own_domain.assign(static_cast<std::size_t>(table.count), 0);
  o.check_kept(table.count);
  return table;
}

std::vector<std::string> as_lines(const MemberTable& table, const EnsembleOptions& options) {
  std::string first = fmt::format("ensemble: {} members, design {}", table.count, table.design);
  if (table.sample_size > 0)
    first +=
        fmt::format(": {} (d + 2) of {} keys, of at most {}", table.sample_size, table.columns.size(), options.members);
  else if (table.count != options.members && !options.is_budget())
    first += fmt::format(", which gives their number itself (members = {} in the recipe)", options.members);
  std::vector<std::string> lines{std::move(first)};
  for (const MemberColumn& column : table.columns) lines.push_back("  " + column.key + ": " + range_of(column));
  return lines;
}

}  // namespace talus::preprocess
