// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "common/recipe/values.hpp"
#include "common/stage/stage.hpp"

namespace talus {
std::string own_recipe(const recipe::Recipe& recipe, const std::string& options_toml) {
  return fmt::format("[scene]\nname = {}\ntitle = {}\n\n{}", recipe::toml_text(recipe.scene_name()),
                     recipe::toml_text(recipe.title()), options_toml);
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
  for (const auto& input : inputs) {
    const auto noted = [&](const auto& one) { return one.first == input; };
    const auto& known = context.made_of.inputs;
    if (!input.empty() && std::none_of(known.begin(), known.end(), noted)) text += input_line("input", input);
  }
  const auto tells_hardware = [](const auto& fact) { return fact.first == "hardware"; };
  if (std::none_of(facts.begin(), facts.end(), tells_hardware)) text += fact_line("hardware", hardware());
  for (const auto& [name, value] : facts) text += fact_line(name, value);
  return text + "\n" + own_recipe(context.recipe, options_toml);
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
