// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/compare/compare.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/gis/escaped_xml.hpp"
#include "common/recipe/paths.hpp"
#include "common/recipe/used.hpp"
#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/report/page.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

constexpr const char* style = R"(
body{font:16px/1.45 system-ui,sans-serif;color:#1b1e22;max-width:70rem;margin:0 auto;padding:1rem 1.2rem}
h1{font-size:1.5rem;margin:.4rem 0}h2{font-size:1.15rem;margin:1.6rem 0 .4rem}
img{width:100%;height:auto;display:block}figcaption{font-size:.9rem;margin:.4rem 0}
table{border-collapse:collapse;width:100%;font-size:.92rem;table-layout:fixed}
th,td{text-align:left;vertical-align:top;padding:.25rem .6rem;border-bottom:1px solid #d8dce1;overflow-wrap:anywhere}
th{vertical-align:bottom}th:first-child{width:40%}h1,p,figcaption{overflow-wrap:anywhere}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}
.charts{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,20rem),1fr));gap:.6rem 1.2rem}
.charts svg{width:100%;height:auto}.key{width:2.5rem;height:.6rem}svg text{font-size:11px;fill:#33363c}
figure{margin:0}.charts figcaption{font-weight:600;margin:.4rem 0 0}
svg .m{text-anchor:middle}svg .e{text-anchor:end}
svg .g{stroke:#e3e5e8;fill:none}svg .a,svg .b{fill:none;stroke:#1a1c20;stroke-width:1.8}
svg .b{stroke:#00735c;stroke-dasharray:7 4}
@media(max-width:600px){body{padding:.8rem .7rem}table{font-size:.8rem}th,td{padding:.2rem .25rem}
th:first-child{width:34%}}
.k{display:inline-block;width:1.1em;height:1.1em;vertical-align:-.15em;border:1px solid #888;margin:0 .3em 0 .9em}
@media print{body{max-width:none;font-size:11px}h2{break-after:avoid}tr{break-inside:avoid}}
)";

/// "wall_time_s" -> "wall time [s]"
std::string label_of(const std::string& key) {
  static const std::pair<const char*, const char*> units[] = {
      {"_m3", "m\u00b3"},       {"_m2", "m\u00b2"}, {"_m_s", "m/s"}, {"_kpa", "kPa"}, {"_deg", "\u00b0"},
      {"_kg_m3", "kg/m\u00b3"}, {"_J", "J"},        {"_N", "N"},     {"_s", "s"},     {"_m", "m"}};
  std::string words = key, unit;
  for (const auto& [end, name] : units) {
    if (!unit.empty() || !words.ends_with(end)) continue;
    unit = name;
    words.erase(words.size() - std::string(end).size());
  }
  for (char& c : words)
    if (c == '_') c = ' ';
  return unit.empty() ? words : fmt::format("{} [{}]", words, unit);
}

/// The headings of the page, and the beginnings of the keys of score.json below each.
const std::vector<std::pair<const char*, std::vector<const char*>>> sections = {
    {"Volumes", {"volume_", "release_", "map_"}},
    {"Run-out and extent",
     {"runout_m", "drop_", "h_over_l", "fahrboeschung", "max_", "affected_", "deposit_area", "thalweg",
      "centre_of_mass_t", "centre_of_mass_d", "travel_angle"}},
    {"Against the survey",
     {"footprint_", "deposit_", "thickness_", "residual_", "survey_", "runout_", "centre_of_mass_", "spi"}},
    {"Cost", {"particles", "steps", "wall_time", "on", "precision", "version", "stop_reason", "time_end"}}};

std::string value_text(const Json& value) {
  if (value.is_string()) return without_absolute_paths(value.get<std::string>());
  if (value.is_number_integer()) return value.dump();
  if (value.is_number()) {
    const double number = value.get<double>();
    return std::abs(number) >= 1e5 ? fmt::format("{:.0f}", number) : fmt::format("{:.4g}", number);
  }
  return value.is_null() ? "\u2013" : value.dump();
}

/// "+12.3 (+4 %)"
std::string change(const Json& a, const Json& b) {
  if (!a.is_number() || !b.is_number()) return "";
  const double from = a.get<double>(), to = b.get<double>();
  if (from == to) return "0";
  const double percents = from != 0 ? 100 * (to - from) / std::abs(from) : 0;  // a thousand and more say nothing
  const std::string percent = percents == 0 || std::abs(percents) >= 1000 ? ""
                              : std::abs(percents) >= 10                  ? fmt::format(" ({:+.0f} %)", percents)
                                                                          : fmt::format(" ({:+.2g} %)", percents);
  return fmt::format("{:+.4g}{}", to - from, percent);
}

/// A row of cells of a kind, "td" or "th"; with `numbers` all but the first stand to the right.
std::string row(const std::vector<std::string>& cells, bool numbers, const char* kind = "td") {
  std::string text = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i)
    text += fmt::format("<{0}{1}>{2}</{0}>", kind, i > 0 && numbers ? " class=\"n\"" : "", escaped_xml(cells[i]));
  return text + "</tr>";
}

std::string table(const std::vector<std::string>& heads, const std::string& rows, bool numbers) {
  return "<table><thead>" + row(heads, numbers, "th") + "</thead><tbody>\n" + rows + "</tbody></table>\n";
}

Json score_of(const ComparedRun& run) {
  Json score = Json::parse(run.score, nullptr, false);
  return score.is_object() ? score : Json::object();
}

using Keys = std::map<std::string, std::string>;

Keys keys_of(const ComparedRun& run) {
  Keys keys;
  for (const std::string& text : run.used)
    for (const recipe::UsedKey& key : recipe::read_used_recipe(text, run.name).keys)
      keys["[" + key.table + "] " + key.key] = key.value;
  return keys;
}

/// A heading as it fits what the runs were compared with: another model's run is no survey.
std::string heading_for(const std::string& title, const ComparedRun& first, const ComparedRun& second) {
  const auto of_model = [](const ComparedRun& run) {
    const Keys keys = keys_of(run);
    const auto kind = keys.find("[postprocess.survey] kind");
    return kind != keys.end() && kind->second == "\"model\"";
  };
  return title == "Against the survey" && (of_model(first) || of_model(second)) ? "Against the reference" : title;
}

/// The numbers of both scores, each under the first heading that claims it.
std::string score_tables(const ComparedRun& first, const ComparedRun& second) {
  const Json a = score_of(first), b = score_of(second);
  Json all = a;
  all.update(b);  // the order of the first, then what the second alone has
  std::map<std::string, std::string> rows;
  for (const auto& [key, unused] : all.items()) {
    if (key == "title" || all[key].is_structured()) continue;
    std::string heading;
    for (const auto& [title, beginnings] : sections)
      for (const char* beginning : beginnings)
        if (heading.empty() && key.starts_with(beginning)) heading = title;
    const Json ours = a.value(key, Json(nullptr)), theirs = b.value(key, Json(nullptr));
    rows[heading] += row({label_of(key), value_text(ours), value_text(theirs), change(ours, theirs)}, true) + "\n";
  }
  std::string text;
  const std::vector<std::string> heads{"", first.name, second.name, "second less first"};
  for (const auto& [title, beginnings] : sections)
    if (!rows[title].empty())
      text += fmt::format("<h2>{}</h2>\n", heading_for(title, first, second)) + table(heads, rows[title], true);
  if (!rows[""].empty()) text += "<h2>Everything else</h2>\n" + table(heads, rows[""], true);
  return text;
}

/// The keys of the recipes in which the two differ.
std::string recipe_table(const ComparedRun& first, const ComparedRun& second) {
  const Keys a = keys_of(first), b = keys_of(second);
  Keys all = a;
  all.insert(b.begin(), b.end());
  std::string rows;
  const auto value = [](const Keys& keys, const std::string& key) {
    const auto found = keys.find(key);
    return found == keys.end() ? std::string("\u2013") : without_absolute_paths(found->second);
  };
  for (const auto& [key, unused] : all)
    if (value(a, key) != value(b, key)) rows += row({key, value(a, key), value(b, key)}, false) + "\n";
  if (a.empty() || b.empty())
    return "<p>What one of the two was computed with is not known: its used recipes are gone.</p>";
  if (rows.empty()) return "<p>The two were computed with the same values.</p>";
  return table({"key", first.name, second.name}, rows, false);
}

std::string legend(const DepositDifference& found, const ComparedRun& first, const ComparedRun& second,
                   double threshold) {
  const auto limits = difference_limits(found);
  std::string text = fmt::format(
      "Deposit of {} less that of {}, vertical, in metres. Outlines at {:g} m: solid {}, dashed green {}.<br>",
      escaped_xml(second.name), escaped_xml(first.name), threshold, escaped_xml(first.name), escaped_xml(second.name));
  if (limits.empty()) return text + "The deposits are the same.";
  for (const bool gain : {false, true}) {
    text += gain ? "<br>thicker:" : "thinner:";
    for (std::size_t i = 0; i < limits.size(); ++i)
      text += fmt::format("<svg class=\"k\"><rect width=\"100%\" height=\"100%\" fill=\"{}\"/></svg>{}",
                          hex(difference_colour(gain, i, limits.size())), class_label(i, limits));
  }
  return text;
}

std::string difference_words(const DepositDifference& d) {
  std::string rows;
  const auto add = [&](const char* name, const std::string& value) { rows += row({name, value}, true) + "\n"; };
  add("share of the deposit that lies elsewhere (volumes set equal)", fmt::format("{:.3g} %", 100 * d.moved));
  add("overlap of the deposits, area of both over area of either", fmt::format("{:.3f}", d.overlap));
  add("root mean square of the difference over either", fmt::format("{:.3g} m", d.rms));
  add("thinner by at most", fmt::format("{:.3g} m", d.smaller));
  add("thicker by at most", fmt::format("{:.3g} m", d.larger));
  add("99 % of the cells of either differ by less than", fmt::format("{:.3g} m", d.p99));
  add("volume, second less first", fmt::format("{:+.4g} m\u00b3", std::abs(d.volume) < 1e-6 ? 0 : d.volume));
  return table({"deposits", ""}, rows, true);
}

/// What makes the two hard to compare.
std::string remarks(const ComparedRun& first, const ComparedRun& second) {
  const MapGrid &a = first.run.maps.grid, &b = second.run.maps.grid;
  std::string text;
  if (!a.has_cells_of(b))
    text += fmt::format(
        "<p>The grids differ ({} x {} cells of {:g} m and {} x {} of {:g} m): the second deposit was "
        "brought to the first one's grid by area weights, which keep its volume.</p>",
        a.columns, a.rows, a.cell, b.columns, b.rows, b.cell);
  if (first.score.empty() || second.score.empty())
    text += "<p>One of the two has no score.json, so that its column is empty: run talus-postprocess there.</p>";
  return text;
}

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

std::string comparison_html(const ComparedRun& first, const ComparedRun& second, double threshold) {
  const DepositDifference found = deposit_difference(first.run.maps, second.run.maps, threshold);
  const std::string title = first.name + " and " + second.name;
  return fmt::format(
      R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src {policy}">
<style>{style}</style></head><body>
<h1>{title}</h1>
<p>{first} ({first_name}) beside {second} ({second_name}). Made with Talus {version}.</p>
{remarks}<figure><img alt="Map of the difference of the deposits" src="data:image/png;base64,{map}">
<figcaption>{legend}</figcaption></figure>
{difference}{charts}{scores}<h2>Recipes: what differs</h2>
{recipes}</body></html>
)",
      fmt::arg("title", escaped_xml(title)), fmt::arg("style", style), fmt::arg("policy", policy_source(style)),
      fmt::arg("first", escaped_xml(first.run.summary.title)),
      fmt::arg("second", escaped_xml(second.run.summary.title)), fmt::arg("first_name", escaped_xml(first.name)),
      fmt::arg("second_name", escaped_xml(second.name)), fmt::arg("version", escaped_xml(version())),
      fmt::arg("remarks", remarks(first, second)),
      fmt::arg("map", base64(difference_map(first.run, second.run, found, threshold))),
      fmt::arg("legend", legend(found, first, second, threshold)), fmt::arg("difference", difference_words(found)),
      fmt::arg("charts", history_charts(first, second)), fmt::arg("scores", score_tables(first, second)),
      fmt::arg("recipes", recipe_table(first, second)));
}

void compare(StageContext& context, const fs::path& other) {
  auto options = context.recipe.read<Options>("postprocess");
  const fs::path there = fs::absolute(other).lexically_normal();
  const fs::path folder = there.filename().empty() ? there.parent_path() : there;
  if (folder == context.out)
    throw RecipeError(Fault{fmt::format("--against {}: this is the run itself", other.string()), "",
                            "Name the folder of another run"});
  ComparedRun first = read_compared(context.out, context.out / "run.h5"),
              second = read_compared(folder, folder / "run.h5");
  options.settle_thresholds(first.run.maps.threshold);
  name_apart(first, second, context.out, folder);
  const std::string page = comparison_html(first, second, options.deposit_threshold);
  if (context.check_only) return;
  context.results.push_back(context.out / "comparison.html");
  write_text(context.results.back(), page);
}

}  // namespace talus::postprocess
