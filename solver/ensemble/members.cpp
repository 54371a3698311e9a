// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/members.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "common/domain/scale_release.hpp"
#include "common/ensemble/counts.hpp"
#include "common/stage/console.hpp"
#include "common/stage/stage.hpp"
#include "solver/run/named_places.hpp"
#include "solver/run/run_inputs.hpp"

namespace talus::solver {
namespace {

/// Keys by which the stiffness and the steps are settled.
constexpr const char* settling_keys[] = {"solve.material.stiffness",
                                         "solve.material.stiffness_strain",
                                         "solve.material.youngs_modulus_Pa",
                                         "solve.accuracy",
                                         "solve.integrator",
                                         "solve.cfl",
                                         "solve.kappa",
                                         "solve.preset"};

bool varies_settling(const MemberTable& table) {
  return table.slides || std::any_of(std::begin(settling_keys), std::end(settling_keys),
                                     [&](const char* key) { return table.find(key) != nullptr; });
}

/// Whether a member's maps can be counted: on the grid of the base domain, of a slide on its window of the lattice.
bool is_countable(const MapGrid& own, const MemberTable& table, std::int64_t member, const MapGrid& base) {
  if (!table.slides)
    return own.columns == base.columns && own.rows == base.rows && own.west == base.west && own.south == base.south &&
           own.cell == base.cell;
  const auto found = window_on(table.slides->lattice, own);
  const CellWindow& w = table.slides->windows[static_cast<std::size_t>(member)];
  return found && found->column == w.column && found->row == w.row && found->columns == w.columns &&
         found->rows == w.rows;
}

SolveOptions settled_by(const SettledOnce& settled, SolveOptions options) {
  if (settled.stiffness) options = with_stiffness(std::move(options), *settled.stiffness);
  if (settled.steps) options = with_steps(std::move(options), *settled.steps);
  return options;
}

/// What is left to the program, settled by the base domain, and said.
SettledOnce settle_once(const Domain& domain, const SolveOptions& base) {
  SettledOnce settled;
  const SolveOptions stiff = settle_stiffness(domain, base);
  if (leaves_stiffness(base)) settled.stiffness.emplace().modulus = stiff.material.youngs_modulus;
  if (base.integrator != Integrator::automatic) return settled;
  settled.steps = choose_steps(domain, stiff);
  for (const std::string& reason : settled.steps->reasons) log_info("steps: " + reason);
  return settled;
}

}  // namespace

Members::Members(const recipe::Recipe& recipe, const MemberTable& table, const EnsemblePaths& paths,
                 const Domain& domain, const SolveOptions& base)
    : recipe_(recipe),
      table_(table),
      paths_(paths),
      domain_(domain),
      settles_each_(varies_settling(table)),
      settled_(settles_each_ ? SettledOnce{} : settle_once(domain, base)),
      base_(settles_each_ ? settle_steps(domain, settle_stiffness(domain, base)) : settled_by(settled_, base)) {
  if (const std::string unkept = unkept_accuracy(domain, base); !unkept.empty()) log_warning(unkept);
}

SolveOptions Members::options_of(std::int64_t member) const {
  try {
    return solver::options_of(recipe_.with(table_.values_of(member, "solve.")), paths_.out);
  } catch (const RecipeError& error) {
    std::vector<Fault> faults = error.faults();
    for (Fault& fault : faults) fault.what = fmt::format("member {}: {}", member, fault.what);
    throw RecipeError(std::move(faults));
  }
}

void Members::check() const {
  for (std::int64_t member = 0; member < table_.count; ++member) {
    stop_if_interrupted("checking the members");
    options_of(member);
  }
}

Domain Members::domain_of(std::int64_t member) const {
  if (const MemberWords* failure = table_.failure_of(member)) throw DataError({failure->words, "", ""});
  const bool own = table_.own_domain.at(static_cast<std::size_t>(member)) != 0;
  Domain domain = own ? read_domain(paths_.domain(member)) : domain_;
  if (own && !is_countable(domain.grid, table_, member, domain_.grid))
    throw DataError(
        {paths_.domain(member).string() + (table_.slides ? ": its grid is not the window that members.h5 has for it"
                                                         : ": its grid is not that of the base domain"),
         "maps of several grids cannot be counted together",
         "Leave keys that change the grid as they are in all members, and run talus-preprocess again"});
  if (const MemberColumn* factor = table_.find(thickness_factor_key); factor != nullptr)
    scale_release(domain, factor->values.at(static_cast<std::size_t>(member)));
  return domain;
}

Member Members::read(std::int64_t member) const {
  Member read{domain_of(member), {}};
  {
    const std::lock_guard<std::mutex> one(reading_);
    read.options = with_places(options_of(member), read.domain.places);
  }
  if (!settles_each_) {
    read.options = settled_by(settled_, std::move(read.options));
    return read;
  }
  const QuietThread quiet;
  read.options = settle_steps(read.domain, settle_stiffness(read.domain, std::move(read.options)));
  return read;
}

}  // namespace talus::solver
