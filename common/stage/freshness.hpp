// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the results of a stage are up to date: by what STAGE.used.toml says of them, and by no time of a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace talus {

struct Stage;
struct StageContext;

/// What the results of a stage are made of.
struct Ingredients {
  /// Tables of the recipe, defaults filled in, each with the SHA-256 of its text.
  std::vector<std::pair<std::string, std::string>> tables = {};
  /// Files with their SHA-256: empty where one is no plain file, none where the stage notes it as it reads the file.
  std::vector<std::pair<std::filesystem::path, std::optional<std::string>>> inputs = {};
};

/// The ingredients of a call as they are now. Throws what the stage throws where the recipe or an input is wrong.
Ingredients ingredients_of(const Stage& stage, const StageContext& context);

/// The line of a used recipe for a fact, "# name: value"; a value with line breaks stays in its comment.
std::string fact_line(const std::string& name, std::string value);

/// The line of a used recipe for a file; with the checksum as it was read where none is given.
std::string input_line(const std::string& name, const std::filesystem::path& file,
                       const std::optional<std::string>& checksum = {});

/// The lines of a used recipe that say them.
std::string lines_of(const Ingredients& ingredients);

/// "OUT/solve.used.toml", of a part "OUT/solve.0-250.used.toml".
std::filesystem::path used_recipe_file(const Stage& stage, const StageContext& context);

/// Completes the used recipe of a stage that has written all results: adds their names and ids.
void note_results(const Stage& stage, const StageContext& context);

struct Verdict {
  std::string run_because = {};                     ///< why the stage runs; empty: the results are up to date
  std::string remark = {};                          ///< a warning where they are
  std::vector<std::filesystem::path> results = {};  ///< all that the stage has written, where they are up to date
};

/// The rule of freshness. Results are up to date where the used recipe names the same version and the same tables,
/// where each input has the checksum noted, and where each result is there with the id noted. A missing input counts as
/// unchanged; the remark names it.
Verdict judge_freshness(const Stage& stage, const StageContext& context);

}  // namespace talus
