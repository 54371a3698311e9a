// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/freshness.hpp"

#include <fmt/format.h>

#include <optional>

#include "common/domain/domain_facts.hpp"
#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/ensemble/slide_options.hpp"
#include "common/run/run_facts.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/stage.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

fs::path note_of(const Request& request, const StageState& state) {
  return request.out / ".inputs" / (state.stage + ".toml");
}

/// A note without its first line, the arguments: where a stage ran does not make its results stale.
std::string table_of(const std::string& note) { return note.substr(std::min(note.find('\n'), note.size() - 1) + 1); }

/// A noted table without the [budget] behind it: a run that had one is no other run without it.
std::string without_budget(const std::string& table) { return table.substr(0, table.find("\n[budget]")); }

/// Why the checksum of a table in a result is not the recipe's; empty where it is, and where nobody can tell.
std::string other_mark(const recipe::Recipe& recipe, const char* table, const Facts& facts, const char* name) {
  const std::string own = recipe_mark(recipe, table), found = fact(facts, name);
  if (!recipe.canonical(table) || found.empty() || own == found) return "";
  return fmt::format("another recipe made it: the checksum of its [{}] is {}, that of the recipe {}", table, found,
                     own);
}

/// What domain, and members of an ensemble, say of the recipe that made them.
std::string other_members(const Request& request, const recipe::Recipe& recipe, const fs::path& domain) {
  std::string other = other_mark(recipe, "preprocess", domain_facts(domain), recipe_of_domain);
  const fs::path members = EnsemblePaths{request.out}.members();
  if (!other.empty() || !ensemble_of(recipe).on() || !fs::exists(members)) return other;
  const std::string why =
      other_mark(recipe, members_table(recipe), read_member_table(members).provenance, recipe_of_members);
  return why.empty() ? "" : fmt::format("{}: {}", members.filename().string(), why);
}

/// What the result itself says of the recipe that made it.
std::string other_recipe(const Request& request, const recipe::Recipe& recipe, const StageState& state) {
  const fs::path& result = state.depends.results.front();
  try {
    if (state.stage == "preprocess") return other_members(request, recipe, result);
    if (state.stage != "solve") return "";
    const Facts facts = ensemble_of(recipe).on() ? counts_facts(result) : run_facts(result);
    const auto& inputs = state.depends.inputs;
    const bool own_domain = std::find(inputs.begin(), inputs.end(), request.out / "domain.vdb") != inputs.end();
    const std::string domain = own_domain ? other_mark(recipe, "preprocess", facts, recipe_of_domain) : "";
    return domain.empty() ? other_mark(recipe, "solve", facts, recipe_of_run) : domain;
  } catch (const DataError& error) {
    return fmt::format("it cannot be read ({})", error.what());
  }
}

/// Why the stage runs, as far as the recipe tells.
std::string changed_recipe(const Request& request, const recipe::Recipe& recipe, const StageState& state) {
  const std::string name = state.depends.results.front().filename().string();
  const auto noted = text_if_there(note_of(request, state));
  if (noted && table_of(*noted) != state.own_table && without_budget(table_of(*noted)) != state.own_table)
    return fmt::format("[{}] or [scene] has changed", state.stage);
  if (!noted && state.stage == "postprocess") return fmt::format("nobody noted what {} was made with", name);
  const std::string other = other_recipe(request, recipe, state);
  return other.empty() ? "" : fmt::format("{}: {}", name, other);
}

/// Why the stage runs, as far as files and their times tell; inputs that are not there go into `missing`.
std::string changed_files(const Request& request, const StageState& state, std::string& missing) {
  const auto made = fs::last_write_time(state.depends.results.front());
  const std::string name = state.depends.results.front().filename().string();
  for (const fs::path& result : state.depends.results)
    if (!fs::exists(result)) return fmt::format("there is no {}", result.filename().string());
  for (const fs::path& input : state.depends.inputs) {
    if (!fs::exists(input)) {
      missing += (missing.empty() ? "" : ", ") + input.string();
    } else if (fs::last_write_time(input) > made) {
      return fmt::format("{} is newer than {}", input.string(), name);
    }
  }
  if (fs::last_write_time(program_of(state.stage)) > made)
    return fmt::format("talus-{} is newer than {}", state.stage, name);
  const fs::path noted = note_of(request, state);
  if (fs::exists(noted) && fs::last_write_time(noted) > made)
    return fmt::format("{} was not made anew when the recipe changed", name);
  return "";
}

}  // namespace

Verdict judge(const Request& request, const recipe::Recipe& recipe, const StageState& state) {
  const fs::path& result = state.depends.results.front();
  if (!fs::exists(result)) return {fmt::format("there is no {}", result.filename().string())};
  std::string missing;
  std::string why = changed_recipe(request, recipe, state);
  if (why.empty()) why = changed_files(request, state, missing);
  if (!why.empty() || missing.empty()) return {why};
  return {"", fmt::format("{} is of this very recipe; whether its inputs are still the same cannot be told, for they "
                          "are not here: {}",
                          result.filename().string(), missing)};
}

void note(const Request& request, const StageState& state) {
  const std::string arguments = state.stage == "solve" ? "--on " + request.on : "";
  const std::string text = fmt::format("# arguments: {}\n{}", arguments, state.own_table);
  const fs::path file = note_of(request, state);
  const auto noted = text_if_there(file);
  if (noted && table_of(*noted) == state.own_table) return;  // as old as the results that were made with it
  write_text(file, text);
}

}  // namespace talus::command
