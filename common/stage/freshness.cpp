// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the used recipe of a stage says, and whether its results are up to date by it and by no time of a file.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/recipe/recipe.hpp"
#include "common/recipe/used.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/context.hpp"
#include "common/stage/files.hpp"
#include "common/stage/stage.hpp"
#include "common/whole_text.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view checksum_mark = "  sha256 ", id_mark = "  id ",
                           no_checksum = "  not a plain file, no checksum";
constexpr std::size_t most_keys_named = 5;

/// "[solve.material]", "[[solve.part]]" -> "solve"; empty: no head of a table.
std::string table_of_head(std::string_view line) {
  const auto begin = line.find_first_not_of('[');
  if (begin == 0 || begin == std::string_view::npos) return "";
  return std::string(line.substr(begin, line.find_first_of(".]", begin) - begin));
}

/// The text of each top-level table.
std::map<std::string, std::string> tables_in(const std::string& toml) {
  std::map<std::string, std::string> tables;
  std::string name;
  for (const std::string& line : lines_in(toml)) {
    if (const std::string head = table_of_head(line); !head.empty()) name = head;
    if (!line.empty()) tables[name] += line + "\n";
  }
  return tables;
}

bool names(const auto& pairs, const auto& name) {
  return std::ranges::any_of(pairs, [&](const auto& one) { return one.first == name; });
}

/// [scene] and a stage's table as a recipe of their own. `options_toml` is the table.
std::string own_recipe(const recipe::Recipe& recipe, const std::string& options_toml) {
  return fmt::format("[scene]\nname = {}\ntitle = {}\n\n{}", recipe::toml_text(recipe.scene_name()),
                     recipe::toml_text(recipe.title()), options_toml);
}

std::string fresh_recipe(const Stage& stage, const StageContext& context) {
  return own_recipe(context.recipe, stage.used_toml(context.recipe));
}

std::string checksum_of(const fs::path& file) {
  std::error_code unknown;
  return fs::is_regular_file(file, unknown) ? sha256(file) : "";
}

fs::path used_recipe_file(const Stage& stage, const StageContext& context) {
  return file_of(stage, context, ".used.toml");
}

/// The line of a used recipe for a fact, "# name: value"; a value with line breaks stays in its comment.
std::string fact_line(const std::string& name, std::string value) {
  std::ranges::replace_if(
      value, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return fmt::format("# {}: {}\n", name, value);
}

/// The line of a used recipe for a file; with the checksum as it was read where none is given.
std::string input_line(const std::string& name, const fs::path& file, const std::optional<std::string>& noted = {}) {
  const std::string checksum = noted ? *noted : checksum_as_read(file);
  const std::string end = checksum.empty() ? std::string(no_checksum) : fmt::format("{}{}", checksum_mark, checksum);
  return fact_line(name, file.string() + end);
}

/// The lines of a used recipe that say what its results are made of.
std::string lines_of(const Ingredients& ingredients) {
  std::string text;
  for (const auto& [name, checksum] : ingredients.tables)
    text += fact_line("table", fmt::format("{}{}{}", name, checksum_mark, checksum));
  for (const auto& [file, checksum] : ingredients.inputs) text += input_line("input", file, checksum);
  return text;
}

/// The part of a fact behind a mark, and the part before it.
std::optional<std::pair<std::string, std::string>> parted(const std::string& fact, std::string_view mark) {
  const auto at = fact.rfind(mark);
  if (at == std::string::npos) return std::nullopt;
  return std::pair{fact.substr(0, at), fact.substr(at + mark.size())};
}

/// What a used recipe says of freshness.
struct Record {
  std::string program;
  std::map<std::string, std::string> tables;
  std::vector<std::pair<fs::path, std::string>> inputs, results;
  std::set<std::string> resolved;  ///< keys whose used value is not that of the table
  std::vector<recipe::UsedKey> keys;
};

void take_fact(Record& record, const std::string& name, const std::string& value) {
  if (name == "program") record.program = value;
  if (name == "resolved") record.resolved.insert(value);
  if (name == "table")
    if (const auto table = parted(value, checksum_mark)) record.tables.insert(*table);
  if (name == "input") {
    const auto input = parted(value, checksum_mark).value_or(std::pair{value.substr(0, value.rfind(no_checksum)), ""});
    record.inputs.emplace_back(input.first, input.second);
  }
  if (name == "result") {
    const auto result = parted(value, id_mark).value_or(std::pair{value, ""});
    record.results.emplace_back(result.first, result.second);
  }
}

/// None where the text is damaged.
std::optional<Record> record_in(const std::string& text, const fs::path& file) {
  try {
    recipe::UsedRecipe used = recipe::read_used_recipe(text, file.string());
    Record record;
    for (const auto& [name, value] : used.facts) take_fact(record, name, value);
    record.keys = std::move(used.keys);
    return record;
  } catch (const DataError&) {
    return std::nullopt;
  }
}

std::string name_of(const recipe::UsedKey& key) { return key.table + "." + key.key; }

/// Keys of either list that are not in the other with the same value.
std::vector<std::string> different_keys(const std::vector<recipe::UsedKey>& noted,
                                        const std::vector<recipe::UsedKey>& fresh) {
  std::map<std::string, std::string> values;
  for (const recipe::UsedKey& key : noted) values[name_of(key)] = key.value;
  std::vector<std::string> different;
  for (const recipe::UsedKey& key : fresh) {
    const auto found = values.find(name_of(key));
    if (found == values.end() || found->second != key.value) different.push_back(name_of(key));
    if (found != values.end()) values.erase(found);
  }
  for (const auto& [name, value] : values) different.push_back(name);
  return different;
}

/// Whether a key stands in a table, or in one within.
bool is_of(const std::string& name, const std::string& table) {
  return name.starts_with(table + ".") || name.starts_with(table + " ");
}

/// The keys of a table whose values are not those noted, those that the stage settles by itself among them.
std::vector<std::string> changed_keys(const Record& record, const std::string& fresh, const std::string& table) {
  std::vector<std::string> changed;
  for (const std::string& name : different_keys(record.keys, recipe::read_used_recipe(fresh, "recipe").keys))
    if (is_of(name, table)) changed.push_back(name);
  return changed;
}

/// ": end_time_s, base.friction_angle_deg"; empty where none is known.
std::string words_of(std::vector<std::string> changed, const Record& record, const std::string& table) {
  const auto resolved = [&](const std::string& name) { return record.resolved.contains(name); };
  if (!std::ranges::all_of(changed, resolved)) std::erase_if(changed, resolved);
  const std::size_t count = changed.size();
  changed.resize(std::min(count, most_keys_named));
  for (std::string& name : changed) name.erase(0, table.size() + 1);
  if (count > most_keys_named) changed.push_back(fmt::format("{} more", count - most_keys_named));
  return changed.empty() ? "" : fmt::format(": {}", fmt::join(changed, ", "));
}

/// Why the recipe is another one; empty where it is not, or states what was used.
std::string changed_tables(const Record& record, const std::string& fresh) {
  const auto tables = tables_in(fresh);
  for (const auto& [name, text] : tables) {
    const auto noted = record.tables.find(name);
    if (noted == record.tables.end()) return fmt::format("[{}] is new", name);
    if (noted->second == sha256_of_text(text)) continue;
    const std::vector<std::string> changed = changed_keys(record, fresh, name);
    const bool known = std::ranges::any_of(record.keys, [&table = name](const recipe::UsedKey& key) {
      return is_of(name_of(key), table);  // those of [scene] are not
    });
    if (!known || !changed.empty()) return fmt::format("[{}] has changed{}", name, words_of(changed, record, name));
  }
  for (const auto& [name, checksum] : record.tables)
    if (!tables.contains(name)) return fmt::format("[{}] is gone", name);
  return "";
}

/// Why the inputs are others; empty where they are not. Inputs that are not there go into `missing`.
std::string changed_inputs(const Record& record, const Dependencies& expected, std::vector<std::string>& missing) {
  for (const auto& [file, checksum] : record.inputs)
    if (!fs::exists(file))
      missing.push_back(file.string());
    else if (!checksum.empty() && checksum_of(file) != checksum)
      return file.string() + " has changed";
  for (const fs::path& file : expected.inputs)
    if (fs::exists(file) && !names(record.inputs, file)) return file.string() + " is new";
  return "";
}

/// Why the results are not those of the record; empty where they are.
std::string changed_results(const Stage& stage, const Record& record, const fs::path& out) {
  for (const auto& [name, id] : record.results) {
    const fs::path file = out / name;
    if (!fs::exists(file)) return fmt::format("there is no {}", name.string());
    if (id.empty() || !stage.id_of) continue;
    try {
      if (const std::string found = stage.id_of(file); found != id)
        return fmt::format("{} is not the one noted: its id is {}, noted is {}", name.string(),
                           found.empty() ? "missing" : found, id);
    } catch (const Error& error) {
      return fmt::format("{} cannot be read ({})", name.string(), error.what());
    }
  }
  return "";
}

/// Why the results that the call makes are not all there, or not noted.
std::string missing_results(const Record* record, const Dependencies& expected, const fs::path& out,
                            const std::string& used_name) {
  for (const fs::path& file : expected.results)
    if (!fs::exists(file)) return fmt::format("there is no {}", file.lexically_relative(out).string());
  for (const fs::path& file : expected.results) {
    const fs::path name = file.lexically_relative(out);
    if (record == nullptr || !names(record->results, name))
      return fmt::format("{} does not say what {} was made of", used_name, name.string());
  }
  return "";
}

std::string program_line(const Stage& stage) { return stage.name + " " + version(); }

/// Why the stage has to run; empty: it does not.
std::string reason_to_run(const Stage& stage, const StageContext& context, const Dependencies& expected,
                          const Record& record, std::vector<std::string>& missing) {
  if (record.program != program_line(stage))
    return fmt::format("{} made its results, this is {}", record.program, version());
  if (std::string why = changed_tables(record, fresh_recipe(stage, context)); !why.empty()) return why;
  if (std::string why = changed_inputs(record, expected, missing); !why.empty()) return why;
  return changed_results(stage, record, context.out);
}

/// The head of a used recipe without the lines that note_results() writes.
std::string without_record(const std::string& head, const Ingredients& ingredients) {
  std::set<std::string> own;
  for (const auto& [file, checksum] : ingredients.inputs) own.insert(file.string());
  std::string kept;
  for (const std::string& line : lines_in(head)) {
    const bool noted =
        line.starts_with("# table: ") || line.starts_with("# result: ") || line.starts_with("# resolved: ");
    constexpr std::string_view input = "# input: ";
    const bool own_input = line.starts_with(input) &&
                           own.contains(line.substr(input.size(), line.find("  ", input.size()) - input.size()));
    if (!noted && !own_input) kept += line + "\n";
  }
  return kept;
}

/// Names of the results below the folder, those that the next stage reads first.
std::vector<std::string> result_names(const Stage& stage, const StageContext& context) {
  std::vector<fs::path> files = stage.depends(context).results;
  files.insert(files.end(), context.results.begin(), context.results.end());
  std::vector<std::string> found;
  for (const fs::path& file : files) {
    const std::string name = file.lexically_relative(context.out).string();
    const bool known = std::ranges::find(found, name) != found.end();
    if (!known && file != used_recipe_file(stage, context) && fs::exists(file)) found.push_back(name);
  }
  return found;
}

}  // namespace

Ingredients ingredients_of(const Stage& stage, const StageContext& context) {
  Ingredients made;
  for (const auto& [name, text] : tables_in(fresh_recipe(stage, context)))
    made.tables.emplace_back(name, sha256_of_text(text));
  const Dependencies depends = stage.depends(context);
  for (const fs::path& file : depends.inputs) {
    if (!fs::exists(file) || names(made.inputs, file)) continue;
    const bool is_sealed = std::ranges::find(depends.sealed, file) != depends.sealed.end();
    made.inputs.emplace_back(file, is_sealed ? std::nullopt : std::optional(checksum_of(file)));
    if (is_sealed) talus::context().note_checksum(file, "");  // not read yet
  }
  return made;
}

void note_results(const Stage& stage, const StageContext& context) {
  const fs::path file = used_recipe_file(stage, context);
  const auto text = text_if_there(file);
  if (!text || context.made_of.tables.empty()) return;
  const auto end_of_head = std::min(text->find("\n\n"), text->size());
  const std::string body = text->substr(end_of_head);
  std::string head = without_record(text->substr(0, end_of_head), context.made_of) + lines_of(context.made_of);
  const auto fresh = recipe::read_used_recipe(fresh_recipe(stage, context), "recipe").keys;
  for (const std::string& key : different_keys(recipe::read_used_recipe(*text, file.string()).keys, fresh))
    head += fact_line("resolved", key);
  for (const std::string& name : result_names(stage, context)) {
    const std::string id = stage.id_of ? stage.id_of(context.out / name) : "";
    head += fact_line("result", name + (id.empty() ? "" : fmt::format("{}{}", id_mark, id)));
  }
  head.pop_back();  // the body begins with the line break
  write_text(file, head + body);
}

Verdict judge_freshness(const Stage& stage, const StageContext& context) {
  const Dependencies expected = stage.depends(context);
  const fs::path file = used_recipe_file(stage, context);
  const std::string name = file.filename().string();
  if (const auto why = missing_results(nullptr, expected, context.out, name); why.starts_with("there is no "))
    return {why};
  const auto text = text_if_there(file);
  if (!text) return {fmt::format("there is no {}", name)};
  const auto record = record_in(*text, file);
  if (!record) return {fmt::format("{} cannot be read", name)};
  std::vector<std::string> missing;
  std::string why = record->tables.empty() ? missing_results(nullptr, expected, context.out, name)
                                           : reason_to_run(stage, context, expected, *record, missing);
  if (why.empty()) why = missing_results(&*record, expected, context.out, name);
  if (!why.empty()) return {why};
  Verdict verdict{.results = expected.results};  // those of this call first
  for (const auto& [result, id] : record->results)
    if (std::ranges::find(verdict.results, context.out / result) == verdict.results.end())
      verdict.results.push_back(context.out / result);
  verdict.results.push_back(file);
  if (!missing.empty())
    verdict.remark = fmt::format("{}: recipe unchanged; inputs are missing and could not be checked: {}",
                                 expected.results.front().filename().string(), fmt::join(missing, ", "));
  return verdict;
}

std::string used_recipe(const StageContext& context, const Stage& stage, const std::string& options_toml,
                        const std::vector<std::filesystem::path>& inputs,
                        const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string text = "# What was used, defaults filled in. This file is itself a recipe.\n";
  text += fact_line("program", stage.name + " " + version());
  text += fact_line("command", context.command_line);
  text += input_line("recipe", context.recipe.file());
  for (const std::string& value : context.recipe.overrides()) text += fact_line("set", value);
  text += lines_of(context.made_of);
  for (const auto& input : inputs)
    if (!input.empty() && !names(context.made_of.inputs, input)) text += input_line("input", input);
  if (!names(facts, "hardware")) text += fact_line("hardware", hardware());
  for (const auto& [name, value] : facts) text += fact_line(name, value);
  return text + "\n" + own_recipe(context.recipe, options_toml);
}

fs::path file_of(const Stage& stage, const StageContext& context, const std::string& ending) {
  return context.out / (stage.table + (context.part.empty() ? "" : "." + context.part) + ending);
}

void write_used_recipe(StageContext& context, const Stage& stage, const std::string& options_toml,
                       const std::vector<std::filesystem::path>& inputs,
                       const std::vector<std::pair<std::string, std::string>>& facts) {
  const auto text = used_recipe(context, stage, options_toml, inputs, facts);
  const auto path = used_recipe_file(stage, context);
  write_text(path, text);
  context.results.push_back(path);
}

}  // namespace talus
