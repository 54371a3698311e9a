// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/output/provenance.hpp"

#include <fmt/format.h>

#include "common/gis/crs.hpp"

namespace talus::preprocess {

Facts facts_of(const Prepared& prepared) {
  const Domain& domain = prepared.domain;
  const MapGrid& grid = domain.grid;
  Facts facts{{"crs", crs_name(grid.crs_wkt)},
              {"grid", fmt::format("{} x {} cells of {:g} m, west {:.10g}, south {:.10g}", grid.columns, grid.rows,
                                   grid.cell, grid.west, grid.south)},
              {"layer_height_m", fmt::format("{:g}", domain.layer_height)},
              {"material_points", std::to_string(prepared.point_count)}};
  for (auto& fact : facts_of(prepared.heights)) facts.push_back(std::move(fact));
  facts.emplace_back(volume_source, prepared.volume_source);
  for (auto& fact : as_facts(prepared.total)) facts.push_back(std::move(fact));
  if (prepared.sliding_surface)
    facts.emplace_back(
        "sliding_surface",
        fmt::format(
            "computed from the outline, curvature {:.4g} 1/m, at most {:.4g} m deep, follows the ground in {} cells",
            prepared.sliding_surface->curvature, prepared.sliding_surface->depth, prepared.sliding_surface->touching));
  if (prepared.by_release.size() < 2) return facts;
  for (const auto& [name, volumes] : prepared.by_release)
    for (auto& [key, value] : as_facts(volumes)) facts.emplace_back(fmt::format("{}.{}", name, key), std::move(value));
  return facts;
}

namespace {

constexpr std::string_view checksum_mark = " sha256 ";

/// The used values of [preprocess] as TOML, in which an input goes by its name wherever it lies.
std::string text_by_names(const Options& used, const Facts& inputs) {
  std::string text = recipe::to_toml(used, "preprocess", false);
  for (const auto& [name, value] : inputs) {
    const std::filesystem::path file = value.substr(0, value.rfind(checksum_mark));
    const std::string opened = recipe::toml_text(file.generic_string());
    const std::string whole = opened.substr(0, opened.size() - 1);  // a layer may follow
    const std::string short_name = '"' + file.filename().string();
    for (auto at = text.find(whole); at != std::string::npos; at = text.find(whole, at + short_name.size()))
      text.replace(at, whole.size(), short_name);
  }
  return text;
}

}  // namespace

Facts checksums_of(const std::vector<std::filesystem::path>& files) {
  Facts inputs;
  for (const auto& file : files) {
    std::string sum;
    if (std::filesystem::is_regular_file(file)) sum = std::string(checksum_mark) + sha256(file);  // some are folders
    inputs.emplace_back("input " + file.filename().string(), file.string() + sum);
  }
  return inputs;
}

void require_unchanged(const Facts& inputs) {
  for (const auto& [name, value] : inputs) {
    const auto end = value.rfind(checksum_mark);
    if (end == std::string::npos) continue;
    const std::string file = value.substr(0, end);
    if (sha256(file) != value.substr(end + checksum_mark.size()))
      throw DataError({file + ": it is not what it was when this stage began", "something writes to it",
                       "Run talus-preprocess again once it stays as it is"});
  }
}

Facts marks_of(const recipe::Recipe& recipe, const Options& used, const Facts& inputs, const std::string& more) {
  std::string text = version() + "\n" + text_by_names(used, inputs);
  for (const auto& [name, value] : inputs) {
    const auto sum = value.rfind(checksum_mark);
    text += name + (sum == std::string::npos ? "" : value.substr(sum)) + "\n";
  }
  if (!more.empty()) text += more + "\n";
  return {{domain_id, sha256_of_text(text).substr(0, mark_digits)},
          {recipe_of_domain, recipe_mark(recipe, "preprocess")}};
}

Facts provenance_of(const StageContext& context, const Facts& inputs, const Facts& marks, const Facts& facts) {
  Facts provenance{{"scene", context.recipe.scene_name()},
                   {"title", context.recipe.title()},
                   {"version", version()},
                   {"command", context.command_line},
                   {"hardware", hardware()}};
  for (const Facts* more : {&inputs, &marks, &facts}) provenance.insert(provenance.end(), more->begin(), more->end());
  return provenance;
}

}  // namespace talus::preprocess
