// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and points of vector files that talus-solve asks for: sections, gauges, lines of inflows.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "common/domain/domain_place.hpp"
#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

/// The attribute that names lines and points where the recipe says nothing; a layer may lack it.
inline constexpr auto usual_name_attribute = "name";

/// One [[preprocess.place]]: lines or points of a vector file, for `place = "..."` in [[solve.section]],
/// [[solve.gauge]] and [[solve.inflow]].
struct PlaceOptions {
  std::string name;
  std::filesystem::path file;
  std::string attribute = usual_name_attribute;

  /// The method declares the keys with defaults and help; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place) {
    v.text("name", name,
           "by which [[solve.section]], [[solve.gauge]] and [[solve.inflow]] ask for it: place = \"...\"");
    v.path("file", file,
           "vector file of lines (sections, inflows) or points (gauges): FILE|layername=LAYER|subset=CONDITION");
    v.needs(!file.empty(), fault(place + ": file is not given", "there is nothing to read", "Name a vector file"));
    v.text("attribute", attribute,
           "the attribute that names each line or point; where a layer has no \"name\" they are NAME-1, NAME-2, ... by "
           "the numbers of their features");
    v.needs(!attribute.empty(), fault(place + ": attribute is empty", "lines and points are recorded under their names",
                                      "Name an attribute, or leave the key out"));
  }
};

/// This function declares the list of places, each of a name of its own.
inline void describe_places(recipe::Visitor& v, std::vector<PlaceOptions>& places) {
  std::set<std::string> names;
  recipe::list(v, "place", places,
               "lines or points of a vector file, for sections, gauges and inflows of [solve]; may be repeated",
               [&](PlaceOptions& one, std::size_t item) {
                 const std::string place = fmt::format("place {}", item + 1);
                 one.describe(v, place);
                 const bool plain = is_plain_name(one.name);
                 v.needs(plain, fault(fmt::format("{}: name = \"{}\"", place, one.name), "[solve] asks for it by name",
                                      "Give it one of letters, digits, - and _"));
                 v.needs(!plain || names.insert(one.name).second,
                         fault(fmt::format("{}: name = \"{}\" is taken", place, one.name),
                               "[solve] asks for it by name", "Give it a name of its own"));
               });
}

}  // namespace talus::preprocess
