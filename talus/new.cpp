// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/domain/domain.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/gis/features.hpp"
#include "common/gis/raster_file.hpp"
#include "common/recipe/dataset_name.hpp"
#include "common/recipe/paths.hpp"
#include "common/recipe/recipe.hpp"
#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

/// Smaller than this many times its standard error a volume may be nothing but error.
constexpr double sure_errors = 3;
/// A release of fewer cells tells nothing of its shape.
constexpr double fewest_released_cells = 9;
/// H/L of a volume scatters by less than this factor (usual_reach.hpp); nobody has measured what a volume does that
/// comes from an area of one inventory.
constexpr double reach_factor = 2, volume_factor = 3, two_sided_95 = 1.96;

fs::path whole(const fs::path& file) {
  if (const auto inside = dataset_name(file.string(), fs::current_path())) return inside->from(fs::current_path());
  return fs::absolute(file).lexically_normal();
}

/// What the first stage needs to be told to read two models; the fewest such keys are taken.
struct Reading {
  bool utm = false;    ///< bring degrees and feet to metres
  bool align = false;  ///< the later model lies beside the earlier one

  std::string keys() const {
    std::string text;
    if (utm) text += "working_crs = \"utm\"            # the models are not in metres\n";
    text +=
        "\n[preprocess.voids]\nfill_m2 = 1e5                  # cells without data inside the models, up to this "
        "area\n";
    if (align)
      text +=
          "\n[preprocess.coregistration]\nmode = \"apply\"                 # the later model lies beside the earlier\n";
    return text;
  }
};

/// The tables that say what fails; `file` writes the name of a file.
template <class Name>
std::string source_keys(const NewScene& scene, const std::vector<double>& place, const Name& file) {
  std::string text;
  if (scene.thickness) {
    text += fmt::format("\n[[preprocess.release]]\npolygons = {}\nthickness_m = {}\n", file(scene.outline),
                        recipe::toml_number(*scene.thickness));
  } else if (!scene.outline.empty())
    text += fmt::format("\n[preprocess.source]\npolygon = {}\n", file(scene.outline));
  else if (!place.empty())
    text +=
        fmt::format("\n[preprocess.source]\nseed_m = [{:.2f}, {:.2f}]  # a point in it, which tells it from others\n",
                    place[0], place[1]);
  for (const auto& [key, value] : {std::pair{"volume_m3", scene.volume}, {"depth_m", scene.depth}})
    if (value)
      text += fmt::format("\n[preprocess.source.sliding_surface]\n{} = {}\n", key, recipe::toml_number(*value));
  if (!scene.ignore.empty()) text += fmt::format("\n[preprocess.difference]\nignore = {}\n", file(scene.ignore));
  return text;
}

/// The keys that name the models; `file` writes the name of a file.
template <class Name>
std::string model_keys(const NewScene& scene, const Name& file) {
  if (scene.thickness) return "base_dem = " + file(scene.before) + "\n";
  return "before_dem = " + file(scene.before) + "\n" +
         (scene.after.empty() ? "" : "after_dem = " + file(scene.after) + "\n");
}

std::string first_recipe(const NewScene& scene, const Reading& reading) {
  const auto file = [](const fs::path& path) { return recipe::toml_text(whole(path).string()); };
  return "[preprocess]\n" + model_keys(scene, file) + reading.keys() + source_keys(scene, scene.at, file);
}

[[noreturn]] void refuse(const NewScene& scene, const std::string& why, const std::string& mend) {
  const std::string what =
      scene.after.empty()
          ? fmt::format("{}: nothing could be released within {}", scene.before.string(), scene.outline.string())
          : fmt::format("{} and {}: no slide was found between them", scene.before.string(), scene.after.string());
  throw DataError(Fault{what + ", so that no recipe was written", why, mend});
}

/// The first stage on the two models alone, into a folder that goes again.
Said prepare(const NewScene& scene, const Reading& reading, const fs::path& folder) {
  Request request;
  request.recipe = folder / "recipe.toml";
  request.out = request.shown = folder / "out";
  write_text(request.recipe, first_recipe(scene, reading));
  Said said = call_quietly("preprocess", call_of(request, "preprocess"));
  stop_if_interrupted("comparing the models");
  return said;
}

bool succeeded(const Said& said) { return said.outcome.code == ExitCode::success; }

/// Whether a fault or a warning names a key as its remedy.
bool asks_for(const Said& said, const char* key) {
  const auto& [outcome, lines] = said;
  return std::any_of(outcome.faults.begin(), outcome.faults.end(),
                     [&](const Fault& fault) { return to_string(fault).find(key) != std::string::npos; }) ||
         std::any_of(lines.begin(), lines.end(),
                     [&](const auto& line) { return line.second.find(key) != std::string::npos; });
}

/// Prepares the two models as far as they can be; returns what that takes. Throws where the stage refuses them.
Reading compare_models(const NewScene& scene, const fs::path& folder) {
  Reading reading;
  Said said = prepare(scene, reading, folder);
  if (!succeeded(said) && asks_for(said, "working_crs = \"utm\"")) {
    reading.utm = true;
    said = prepare(scene, reading, folder);
  }
  if (asks_for(said, "mode = \"apply\"")) {  // also a warning, of a run that went through
    const Reading aligned{reading.utm, true};
    if (succeeded(prepare(scene, aligned, folder))) return aligned;
    said = prepare(scene, reading, folder);
  }
  if (succeeded(said)) return reading;
  if (asks_for(said, "doubtful-source"))
    refuse(scene, said.outcome.faults.back().what,
           "Name the slide by --at X,Y or --outline FILE, or mask what is none by --ignore FILE");
  refuse(scene, to_string(said.outcome.faults.back()),
         scene.after.empty()
             ? "Look at both in a GIS: the outline must lie on the model"
             : "Look at both in a GIS: the first must be the ground before the slide, the second after it");
}

struct Found {
  Slide slide;
  double volume_error = nan;  ///< of the release [m3]
  std::vector<double> place;  ///< of its thickest cell, map coordinates [m]
};

std::vector<double> thickest_cell(const Domain& domain) {
  const auto& thickness = domain.release_thickness.values;
  const auto cell = static_cast<std::size_t>(std::ranges::max_element(thickness) - thickness.begin());
  const auto [column, row] = domain.grid.cell_of(cell);
  return {domain.grid.x(column), domain.grid.y(row)};
}

Found find_slide(const NewScene& scene, const fs::path& out) {
  const Domain domain = read_domain(out / "domain.vdb");
  const fs::path rose = out / "survey" / "deposit_surveyed.tif";
  std::optional<Raster> deposit;
  if (fs::exists(rose)) deposit = read_raster(rose);
  if (deposit && deposit->values.size() != domain.grid.count()) deposit.reset();
  Found found{measure_slide(domain.before, domain.release_thickness, deposit), nan, thickest_cell(domain)};
  for (const Finding& finding : domain.findings)
    if (finding.name == "larger-lowering") log_warning(finding.message);
  const auto survey = nlohmann::json::parse(text_if_there(out / "survey" / "survey.json").value_or(""), nullptr, false);
  if (!survey.is_discarded() && survey.contains("source") && survey["source"]["error_m3"].is_number())
    found.volume_error = survey["source"]["error_m3"].get<double>();
  const double cells = found.slide.area / (found.slide.cell * found.slide.cell);
  if (cells < fewest_released_cells)
    refuse(
        scene,
        fmt::format("what went down is {:.0f} cells of {:g} m, {:.0f} m3", cells, found.slide.cell, found.slide.volume),
        "Give elevation models with smaller cells, or write the recipe by hand (talus-preprocess --template)");
  if (found.slide.volume < sure_errors * found.volume_error)
    refuse(scene,
           fmt::format("what went down most, {:.0f} m3, is no more than the error of the difference makes of nothing "
                       "({:.0f} m3, one standard error)",
                       found.slide.volume, found.volume_error),
           "If a slide is there all the same, write the recipe by hand with source.polygon around it");
  return found;
}

/// A name for files, from that of the recipe's folder.
std::string scene_name(const fs::path& recipe) {
  std::string name = whole(recipe).parent_path().filename().string();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_') c = '-';
  return name.empty() ? "slide" : name;
}

/// As the recipe names a file: from its own folder where both lie below a folder of their own, whole otherwise.
std::string named(const fs::path& file, const fs::path& recipe) {
  const fs::path there = whole(file), folder = whole(recipe).parent_path();
  if (dataset_name(there.string())) return recipe::toml_text(there.string());
  const bool near = there.has_relative_path() && folder.has_relative_path() &&
                    *there.relative_path().begin() == *folder.relative_path().begin();
  return recipe::toml_text(near ? there.lexically_relative(folder).generic_string() : there.string());
}

std::string way_words(const NewScene& scene, const Slide& s) {
  if (scene.after.empty())
    return "Nothing says how far it goes: friction is the usual one for the volume, with its scatter.";
  if (!s.has_deposit())
    return "The models show no deposit: friction is the usual one for the volume, the end a guess. Look at both.";
  return fmt::format("It fell {:.0f} m over {:.0f} m, H/L {:.2f}; its centre of mass went at {:.2f}.", s.drop, s.length,
                     s.drop / s.length, s.travel_tangent);
}

/// "key = value          # remark"
std::string line(const std::string& key, const std::string& value, const std::string& remark) {
  return fmt::format("{:<30} # {}\n", key + " = " + value, remark);
}

std::string head(const NewScene& scene, const Slide& s) {
  const bool two = !scene.after.empty();
  return fmt::format(
      "# Written by talus new (Talus {}) from {}. Every number is a proposal:\n"
      "# change what you know better. All keys with their meaning: talus-preprocess --template, and so on.\n"
      "#\n"
      "# {}: {:.0f} m3 {} on {:.0f} m2, {:.0f} m wide, {:.3g} m thick (median by volume).\n"
      "# {}\n"
      "[scene]\nname = \"{}\"\n\n",
      version(), two ? "two elevation models" : "an elevation model and an outline", two ? "Found" : "Released",
      s.volume, two ? "went down" : "fail", s.area, s.width, s.median_thickness, way_words(scene, s),
      scene_name(scene.recipe));
}

/// Of the bed [-].
double coefficient_of(const Proposal& p) { return std::tan(p.bed_angle / 180 * std::numbers::pi); }

/// [[ensemble.vary]] of a factor, or of a value, whose logarithm is normal.
std::string lognormal(const std::string& key, double median, double deviation, const std::string& remark) {
  const double mean = median * std::exp(deviation * deviation / 2);
  return fmt::format(
      "\n[[ensemble.vary]]                # {}\nkey = \"{}\"\ndistribution = \"lognormal\"\nmean = {:.3f}\n"
      "deviation = {:.3f}\nlow = {:.3f}\nhigh = {:.3f}\n",
      remark, key, mean, mean * std::sqrt(std::expm1(deviation * deviation)), median * std::exp(-3 * deviation),
      median * std::exp(3 * deviation));
}

/// What is not known of a slope that may fail, for maps of probability.
std::string doubts(const NewScene& scene, const Proposal& p) {
  const double friction = std::log(reach_factor) / two_sided_95, volume = std::log(volume_factor) / two_sided_95;
  std::string text = "\n# Maps of probability: talus run RECIPE --set ensemble.members=100\n[ensemble]\nmembers = 0\n";
  if (!scene.prior.empty())
    text += fmt::format("prior = {}\n", scene.prior.has_extension() ? named(scene.prior, scene.recipe)
                                                                    : recipe::toml_text(scene.prior.string()));
  else
    text += lognormal("solve.base.friction_coefficient", coefficient_of(p), friction,
                      fmt::format("19 of 20 within a factor of {:g}, as H/L scatters", reach_factor));
  if (!scene.thickness && !scene.volume && !scene.depth)
    text += lognormal(thickness_factor_key, 1, volume,
                      fmt::format("a volume from an area: 19 of 20 within a factor of {:g}, assumed", volume_factor));
  return text;
}

std::string recipe_text(const NewScene& scene, const Found& found, const Reading& reading) {
  const Slide& s = found.slide;
  const Proposal p = propose(s);
  const auto file = [&](const fs::path& path) { return named(path, scene.recipe); };
  const auto number = [](double value) { return recipe::toml_number(value); };
  std::string text = head(scene, s);
  text += "[preprocess]\n" + model_keys(scene, file) + reading.keys() +
          source_keys(scene, scene.at.empty() ? found.place : scene.at, file) + "\n[preprocess.grid]\n";
  text += line("spacing_m", number(p.spacing), fmt::format("{:.0f} cells across the release", p.cells_across));
  text += line("layer_height_m", number(p.layer_height),
               fmt::format("{:.1f} layers over its median thickness; four or more", p.layers));
  text += line("points_per_cell", "[2, 2, 2]", fmt::format("about {:.0f} material points", p.points));
  text += "\n[solve]\n";
  text += line("end_time_s", number(p.end_time), "generous: the run stops by itself when all is at rest");
  text += line("stop_kinetic_fraction", "0.001", "at rest: kinetic energy below this part of its peak");
  text += "\n[solve.material]\nmodel = \"drucker-prager\"\ndensity_kg_m3 = 2000.0\n";
  text += line("friction_angle_deg", number(p.internal_angle), "inside the mass: 1.4 times the bed's, as tangents");
  text += line("stiffness", "\"auto\"", "the lowest modulus that leaves the flow unchanged");
  text += "\n[solve.base]\nlaw = \"coulomb\"\n";
  if (scene.after.empty())
    text += line("friction_coefficient", fmt::format("{:.3f}", coefficient_of(p)),
                 "H/L usual for this volume (Scheidegger 1973, Corominas 1996)");
  else
    text += line("friction_angle_deg", number(p.bed_angle),
                 s.has_deposit() ? "0.85 of the tangent at which its centre of mass went: a first guess"
                                 : "usual for this volume (Scheidegger 1973, Corominas 1996)");
  text += "\n[postprocess]\n";
  text += line("friction_is", "\"guessed\"", "once it is: \"given\" (from elsewhere), or \"fitted\" to this event");
  if (scene.after.empty()) return text + doubts(scene, p);
  text += "\n[postprocess.survey]\n";
  text += line("from_preprocess", "true", "scored against what rose between the two models");
  return text;
}

/// Whether a file holds polygons; elevation models, tables of points among them, hold none.
bool holds_polygons(const fs::path& file) {
  const RedirectLog log([](LogLevel, const std::string&) {});
  const Findings found("new", {}, Findings::Log::kept_back);
  try {
    return !read_polygons(file, "").empty();
  } catch (const DataError&) {
    return false;
  }
}

/// Puts the outline in its place where the second file is one.
NewScene settled(NewScene scene) {
  if (holds_polygons(scene.after)) {
    if (!scene.outline.empty() || !scene.at.empty() || !scene.ignore.empty())
      throw RecipeError(Fault{fmt::format("{}: no elevation model", scene.after.string()),
                              "--at, --outline and --ignore say which change between two models is the slide",
                              "Give two elevation models, or leave them out"});
    std::swap(scene.outline, scene.after);
  }
  const int amounts = scene.thickness.has_value() + scene.volume.has_value() + scene.depth.has_value();
  if (amounts > 1)
    throw RecipeError(Fault{"--thickness, --volume, --depth: more than one", "each says by itself how much is released",
                            "Leave the others out"});
  if ((amounts > 0 || !scene.prior.empty()) && !scene.after.empty())
    throw RecipeError(Fault{fmt::format("{}: it holds no polygons, or is not there", scene.after.string()),
                            "--thickness, --volume, --depth and --prior are for what may fail within an outline",
                            "Name its file, or leave the option out"});
  return scene;
}

}  // namespace

int new_scene(const NewScene& asked) {
  const NewScene scene = settled(asked);
  if (fs::exists(scene.recipe) && !scene.overwrite)
    throw DataError(Fault{scene.recipe.string() + ": it is there already", "nothing is written over",
                          "Name another file with --recipe FILE, or give --overwrite"});
  const TemporaryFolder folder("talus-new");
  for (const fs::path& file : {asked.before, asked.after}) show_path_as(whole(file), file.string(), "");
  const Reading reading = compare_models(scene, folder.path());
  const Found found = find_slide(scene, folder.path() / "out");
  if (const fs::path parent = scene.recipe.parent_path(); !parent.empty()) make_folder(parent);
  write_text(scene.recipe, recipe_text(scene, found, reading));
  log_info(fmt::format("{:.0f} m3 {}. {}", found.slide.volume, scene.after.empty() ? "fail" : "failed",
                       way_words(scene, found.slide)));
  const std::string recipe = scene.recipe.string();
  log_info(scene.after.empty()
               ? fmt::format("Read it, then: talus run {0}; talus run {0} --set ensemble.members=100", recipe)
               : fmt::format("Read it, then: talus run {0}; talus fit {0} finds the friction of this deposit", recipe));
  print_results({scene.recipe});
  return 0;
}

}  // namespace talus::command
