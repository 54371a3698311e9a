// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/compare/compare.hpp"

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/input_file.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

/// The run of a folder with what its stages left there, as far as it is of that run.
ComparedRun read_compared(const fs::path& folder, const fs::path& file) {
  ComparedRun compared{.name = folder.filename().string(), .run = read_run(file), .score = {}, .used = {}};
  const Facts& facts = compared.run.summary.provenance;
  const std::string id = fact(facts, run_id);
  compared.score = text_if_there(folder / "score.json").value_or("");
  if (!id.empty() && !compared.score.empty() && compared.score.find('"' + id + '"') == std::string::npos) {
    warn("score-of-another-run",
         fmt::format("{}: it is of another run than {}; the page leaves it out", (folder / "score.json").string(), id));
    compared.score.clear();
  }
  for (const auto& [stage, of] :
       {std::pair{"preprocess", fact(facts, domain_id)}, {"solve", id}, {"postprocess", {}}}) {
    const std::string used = text_if_there(folder / (std::string(stage) + ".used.toml")).value_or("");
    if (!used.empty() && is_used_recipe_of(used, of)) compared.used.push_back(used);
  }
  return compared;
}

/// Two folders of the same last name are told apart by those above them.
void name_apart(ComparedRun& first, ComparedRun& second, fs::path a, fs::path b) {
  while (first.name == second.name && a.has_relative_path() && b.has_relative_path()) {
    a = a.parent_path();
    b = b.parent_path();
    first.name = a.filename().string() + "/" + first.name;
    second.name = b.filename().string() + "/" + second.name;
  }
}

}  // namespace

void compare(StageContext& context, const fs::path& other) {
  const auto options = context.recipe.read<Options>("postprocess");
  const fs::path there = fs::absolute(other).lexically_normal();
  const fs::path folder = there.filename().empty() ? there.parent_path() : there;
  if (folder == context.out)
    throw RecipeError(Fault{fmt::format("--against {}: this is the run itself", other.string()), "",
                            "Name the folder of another run"});
  ComparedRun first = read_compared(context.out, context.out / "run.h5"),
              second = read_compared(folder, folder / "run.h5");
  name_apart(first, second, context.out, folder);
  const std::string page = comparison_html(first, second, options.deposit_threshold);
  if (context.check_only) return;
  context.results.push_back(context.out / "comparison.html");
  write_text(context.results.back(), page);
}

}  // namespace talus::postprocess
