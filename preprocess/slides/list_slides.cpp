// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <set>

#include "common/error.hpp"
#include "common/recipe/recipe.hpp"
#include "preprocess/slides/slides.hpp"

namespace talus::preprocess {
namespace {

/// A layer of polygons, read once.
class Layers {
 public:
  explicit Layers(const std::string& crs_wkt) : crs_wkt_(crs_wkt) {}
  const std::vector<PolygonFeature>& read(const std::filesystem::path& source) {
    const auto [found, is_new] = read_.try_emplace(source.string());
    if (is_new) found->second = read_polygon_features(source, crs_wkt_);
    return found->second;
  }

 private:
  const std::string& crs_wkt_;
  std::map<std::string, std::vector<PolygonFeature>> read_;
};

/// The attribute of a feature; the fault is noted where it is missing or NULL.
const FeatureValue* attribute_of(const PolygonFeature& feature, const std::string& name, std::vector<Fault>& faults) {
  std::vector<std::string> names;
  for (const FeatureValue& value : feature.values) {
    names.push_back(value.name);
    if (value.name != name) continue;
    if (!value.is_null) return &value;
    faults.push_back({fmt::format("{}: attribute {} is NULL", feature.place, name), "the slide needs a value",
                      "Give one, or leave the polygon out: outlines = \"FILE|subset=CONDITION\""});
    return nullptr;
  }
  faults.push_back({fmt::format("{}: no attribute {}", feature.place, name),
                    names.empty() ? "it has none" : fmt::format("it has {}", fmt::join(names, ", ")),
                    "Mend the name in [slides], or add the attribute"});
  return nullptr;
}

/// What an attribute gives a key, as text; of what is released it must be a positive number.
std::string text_of(const FeatureValue& value, const std::string& key, const std::string& place,
                    std::vector<Fault>& faults) {
  if (!is_amount(key)) return value.text;
  if (value.number && std::isfinite(*value.number) && *value.number > 0) return recipe::toml_number(*value.number);
  faults.push_back(
      {fmt::format("{}: {} = {}", place, value.name, value.text), "it must be a number above 0", "Mend the attribute"});
  return value.text;
}

Slide from_feature(const PolygonFeature& feature, const SlideOptions& options, std::vector<Fault>& faults) {
  Slide slide;
  slide.place = feature.place;
  slide.source = feature.source;
  slide.outline = feature.polygons;
  slide.name = fmt::format("slide-{}", feature.number);
  if (!options.name_from.empty())
    if (const FeatureValue* name = attribute_of(feature, options.name_from, faults)) slide.name = name->text;
  for (const SlideKeyOptions& one : options.vary)
    if (const FeatureValue* value = attribute_of(feature, one.attribute, faults))
      slide.set.emplace_back(one.key, text_of(*value, one.key, feature.place, faults));
  if (feature.polygons.empty())
    faults.push_back({feature.place + ": no polygon", "a slide is released within its outline",
                      "Draw it, or leave the feature out: outlines = \"FILE|subset=CONDITION\""});
  return slide;
}

/// "key = value" of a recipe, without the blanks and quotes around.
std::pair<std::string, std::string> parted(const std::string& text) {
  const auto bare = [](const std::string& word) {
    const auto first = word.find_first_not_of(" \t\"'"), last = word.find_last_not_of(" \t\"'");
    return first == std::string::npos ? std::string() : word.substr(first, last - first + 1);
  };
  const auto sign = text.find('=');
  if (sign == std::string::npos) return {bare(text), ""};
  return {bare(text.substr(0, sign)), bare(text.substr(sign + 1))};
}

Slide from_scenario(const ScenarioOptions& scenario, Layers& layers, std::vector<Fault>& faults) {
  Slide slide;
  slide.name = scenario.name;
  slide.place = "[[slides.scenario]] " + scenario.name;
  slide.source = scenario.outline;
  for (const PolygonFeature& feature : layers.read(slide.source))
    slide.outline.insert(slide.outline.end(), feature.polygons.begin(), feature.polygons.end());
  if (slide.outline.empty())
    faults.push_back({slide.place + ": no polygon", "its layer holds none that meets its condition",
                      "Mend outline; look at it: ogrinfo -al " + vector_source(slide.source).file.string()});
  for (const std::string& text : scenario.set) {
    slide.set.push_back(parted(text));
    if (slide.set.back().second.empty())
      faults.push_back({fmt::format("{}: set holds \"{}\"", slide.place, text), "it is no key with a value",
                        "Write \"solve.base.friction_angle_deg=18\""});
  }
  return slide;
}

/// Each slide must say how much is released, in a way that the model can take.
void check_amount(const Slide& slide, ModelIs model, std::vector<Fault>& faults) {
  const bool onto = model == ModelIs::base;
  for (const char* key : cut_keys)
    if (onto && slide.sets(key))
      faults.push_back({fmt::format("{}: {}, with base_dem", slide.place, key),
                        "what is released lies on base_dem, and has a thickness",
                        fmt::format("Set {} or {}, or give the model as before_dem", thickness_key, volume_key)});
  if (const char* given = slide.sets(thickness_key) ? thickness_key
                          : slide.sets(volume_key)  ? volume_key
                                                    : nullptr;
      given && !onto)
    faults.push_back({fmt::format("{}: {}, with before_dem", slide.place, given),
                      "what fails there lies above a curved sliding surface, and has a largest depth",
                      fmt::format("Set {} or {}, or give the model as base_dem", cut_keys[0], cut_keys[1])});
  if (onto && !slide.sets(thickness_key) && !slide.sets(volume_key) && faults.empty())
    faults.push_back({slide.place + ": no thickness", "nothing says how much is released",
                      fmt::format("Set {} or {}, in [[slides.set]] by an attribute, in [[slides.scenario]] by set",
                                  thickness_key, volume_key)});
}

void check_names(const std::vector<Slide>& slides, std::vector<Fault>& faults) {
  std::map<std::string, std::string> places;
  for (const Slide& slide : slides) {
    if (slide.name.empty() || slide.name.find_first_of("\n\r") != std::string::npos)
      faults.push_back({slide.place + ": its name is empty, or more than a line", "results are told apart by name",
                        "Mend the attribute"});
    const auto [other, is_new] = places.emplace(slide.name, slide.place);
    if (!is_new)
      faults.push_back({fmt::format("{}: name \"{}\" is taken by {}", slide.place, slide.name, other->second),
                        "results are told apart by name", "Name one of them otherwise"});
  }
}

/// All slides set the same keys, each once.
void check_set(const std::vector<Slide>& slides, std::vector<Fault>& faults) {
  const auto keys_of = [&](const Slide& slide) {
    std::set<std::string> keys;
    for (const auto& [key, value] : slide.set)
      if (!keys.insert(key).second)
        faults.push_back({fmt::format("{}: {} is set twice", slide.place, key), "one value would hide the other",
                          "Leave one of them out"});
    return keys;
  };
  if (!faults.empty()) return;
  const std::set<std::string> first = keys_of(slides.front());
  for (const Slide& slide : slides) {
    const std::set<std::string> own = keys_of(slide);
    if (own == first) continue;
    faults.push_back(
        {fmt::format("{}: it sets {}, and {} sets {}", slide.place,
                     own.empty() ? "no key" : fmt::format("{}", fmt::join(own, ", ")), slides.front().place,
                     first.empty() ? "no key" : fmt::format("{}", fmt::join(first, ", "))),
         "the table of slides has a value of each key in every row", "Set the same keys for all"});
  }
}

}  // namespace

std::vector<Slide> list_slides(const SlideOptions& options, ModelIs model, const std::string& crs_wkt) {
  constexpr std::size_t most_faults = 20;
  std::vector<Slide> slides;
  std::vector<Fault> faults;
  Layers layers(crs_wkt);
  if (options.scenario.empty()) {
    const auto& features = layers.read(options.outlines);
    if (const auto [file, layer, where] = vector_source(options.outlines); features.empty())
      throw DataError({file.string() + ": no feature" + (where.empty() ? "" : " whose attributes meet " + where),
                       "each polygon of the layer is a slide", "Mend outlines in [slides]"});
    for (const PolygonFeature& feature : features) slides.push_back(from_feature(feature, options, faults));
  }
  for (const ScenarioOptions& scenario : options.scenario) slides.push_back(from_scenario(scenario, layers, faults));
  for (const Slide& slide : slides) check_amount(slide, model, faults);
  check_names(slides, faults);
  check_set(slides, faults);
  if (faults.empty()) return slides;
  const std::size_t all = faults.size();
  if (all > most_faults) {
    faults.resize(most_faults);
    faults.back().mend += fmt::format(" ({} more faults)", all - most_faults);
  }
  throw DataError(std::move(faults));
}

}  // namespace talus::preprocess
