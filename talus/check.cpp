// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/recipe/overrides.hpp"
#include "common/stage/console.hpp"
#include "common/stage/stage.hpp"
#include "talus/freshness.hpp"
#include "talus/run.hpp"
#include "talus/temporary_folder.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

/// What the stages said, sorted into what ends a run and what does not.
class Listing {
 public:
  /// The faults stand last in what a stage that failed has said, each behind its name.
  void add(const std::string& stage, const Outcome& outcome) {
    code_ = std::max(code_, outcome.code);
    const std::string name = "talus-" + stage + ": ";
    for (std::size_t at = 0; at < outcome.err.size();) {
      const auto end = std::min(outcome.err.find('\n', at), outcome.err.size());
      std::string line = outcome.err.substr(at, end - at);
      at = end + 1;
      if (line.starts_with(name)) put(faults_, stage, line.substr(name.size()));
      if (line.starts_with("warning: ")) put(warnings_, stage, line.substr(9));
      if (line.starts_with("advice: ")) put(advice_, stage, line.substr(8));
    }
  }
  void add_fault(const std::string& stage, const std::string& fault, ExitCode code) {
    code_ = std::max(code_, static_cast<int>(code));
    put(faults_, stage, fault);
  }
  void note(const std::string& text) { notes_.push_back(text); }

  int print(const std::string& scene) const {
    for (const std::string& text : notes_) log_info(text);
    for (const auto& [stage, text] : warnings_) log_warning(fmt::format("{}: {}", stage, text));
    for (const auto& [stage, text] : advice_) log_info(fmt::format("advice: {}: {}", stage, text));
    for (const auto& [stage, text] : faults_) log_error(fmt::format("{}: {}", stage, text));
    log_info(fmt::format("{}: {}, {}", scene, counted(faults_.size(), "fault"), counted(warnings_.size(), "warning")));
    return code_;
  }

 private:
  using Lines = std::vector<std::pair<std::string, std::string>>;
  static std::string counted(std::size_t count, const std::string& what) {
    return fmt::format("{} {}{}", count == 0 ? "no" : std::to_string(count), what, count == 1 ? "" : "s");
  }
  /// A fault of [scene] is found by every stage.
  static void put(Lines& lines, const std::string& stage, const std::string& text) {
    const auto known = [&](const auto& line) { return line.second == text; };
    if (std::none_of(lines.begin(), lines.end(), known)) lines.emplace_back(stage, text);
  }

  Lines faults_, warnings_, advice_;
  std::vector<std::string> notes_;
  int code_ = 0;
};

/// Inputs of the scores that no stage makes and that are not there.
void look_for_files(const Request& request, Listing& listing) {
  for (const fs::path& input : depends_of(request, "postprocess").inputs) {
    const fs::path below = input.lexically_relative(request.out);
    const bool made = !below.empty() && *below.begin() != "..";
    if (!made && !fs::exists(input))
      listing.add_fault("postprocess",
                        input.string() + ": no such file. A recipe names it: put it there, or mend the recipe",
                        ExitCode::data);
  }
}

bool up_to_date(const Request& request, const recipe::Recipe& recipe, const char* stage, const std::string& table) {
  return judge(request, recipe, state_of(request, stage, table)).run_because.empty();
}

/// Data and physics of a recipe whose tables are in order.
void check_together(const Request& request, const std::vector<std::string>& tables, Listing& listing) {
  const recipe::Recipe recipe(request.recipe);
  Request at_work = request;
  std::optional<TemporaryFolder> folder;
  const bool has_domain = up_to_date(request, recipe, "preprocess", tables[0]);
  if (has_domain) {
    listing.add("preprocess", run_stage_program(request, "preprocess", {"--check"}, Keep::everything));
  } else if (recipe.canonical("preprocess")) {
    folder.emplace("talus-check");
    at_work.out = at_work.shown = folder->path();
    const Outcome outcome = run_stage_program(at_work, "preprocess", {}, Keep::everything);
    listing.add("preprocess", outcome);
    if (outcome.code != 0) {
      look_for_files(request, listing);
      return listing.note("solve: its physics can be checked once the domain can be prepared");
    }
  }
  listing.add("solve", run_stage_program(at_work, "solve", {"--check"}, Keep::everything));
  if (has_domain && up_to_date(request, recipe, "solve", tables[1]))
    listing.add("postprocess", run_stage_program(request, "postprocess", {"--check"}, Keep::everything));
  else
    look_for_files(request, listing);
}

}  // namespace

int check_scene(const Request& request) {
  recipe::set_overrides(request.set);
  Listing listing;
  std::vector<std::string> tables;
  bool readable = true;
  for (const char* stage : stage_names) {
    const Outcome used = ask(request, stage, "--used");
    listing.add(stage, used);
    readable = readable && used.code == 0;
    tables.push_back(used.out);
  }
  if (readable) check_together(request, tables, listing);
  return listing.print(request.recipe.filename().string());
}

}  // namespace talus::command
