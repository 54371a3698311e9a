// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/named_places.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace talus::solver {
namespace {

using Found = std::vector<const DomainPlace*>;

/// How far the inner points of an inflow's line may lie beside it, over its length [-].
constexpr double crooked = 0.01;

/// What an item of [solve] asks for.
struct Wish {
  const char* table;  ///< "section"
  std::size_t number;
  const std::string& place;
  const std::string& name;  ///< which of its lines or points; empty: all
  bool line;                ///< a line is wanted, else a point

  /// "[[solve.section]] number 2"
  std::string item() const { return fmt::format("[[solve.{}]] number {}", table, number + 1); }
};

std::string names_of(const Found& found) {
  std::vector<std::string> names;
  for (const DomainPlace* one : found) names.push_back(one->name);
  return fmt::format("{}", fmt::join(names, ", "));
}

Found all_of(const std::string& place, const std::vector<DomainPlace>& places) {
  Found found;
  for (const DomainPlace& one : places)
    if (one.place == place) found.push_back(&one);
  return found;
}

Fault no_such_place(const Wish& wish, const std::vector<DomainPlace>& places) {
  std::vector<std::string> known;
  for (const DomainPlace& one : places)
    if (std::find(known.begin(), known.end(), one.place) == known.end()) known.push_back(one.place);
  return {
      fmt::format("{}: place = \"{}\"", wish.item(), wish.place),
      known.empty() ? "domain.vdb has no places" : fmt::format("domain.vdb has the places {}", fmt::join(known, ", ")),
      "Name one that is there, or read it by [[preprocess.place]] and run talus-preprocess again"};
}

/// What a wish finds. Of a place that holds one line or point it is that one, whatever the name.
Found found_by(const Wish& wish, const std::vector<DomainPlace>& places, std::vector<Fault>& faults) {
  const Found all = all_of(wish.place, places);
  if (all.empty()) {
    faults.push_back(no_such_place(wish, places));
    return {};
  }
  Found found = all;
  if (!wish.name.empty() && all.size() > 1) {
    std::erase_if(found, [&](const DomainPlace* one) { return one->name != wish.name; });
    if (found.empty())
      faults.push_back({fmt::format("{}: place \"{}\" has no \"{}\"", wish.item(), wish.place, wish.name),
                        "it has " + names_of(all), "Name one of them, or leave name out"});
  }
  for (const DomainPlace* one : found)
    if (one->is_line() != wish.line) {
      faults.push_back({fmt::format("{}: \"{}\" of the place \"{}\" is a {}", wish.item(), one->name, one->place,
                                    one->is_line() ? "line" : "point"),
                        wish.line ? fmt::format("the {} is a line", wish.table) : "a gauge is a point",
                        "Name one that fits, or choose by layer and where of [[preprocess.place]]"});
      return {};
    }
  return found;
}

/// The list with what it asks of places put in: make(name, place) gives the options of a line or point. `table` is the
/// recipe's name of the list, `lines` whether lines are wanted.
template <class Options, class Make>
std::vector<Options> placed(const std::vector<Options>& list, const char* table, bool lines,
                            const std::vector<DomainPlace>& places, std::vector<Fault>& faults, const Make& make) {
  std::vector<Options> all;
  for (std::size_t n = 0; n < list.size(); ++n) {
    const Options& o = list[n];
    if (o.place.empty()) {
      all.push_back(o);
      continue;
    }
    for (const DomainPlace* one : found_by({table, n, o.place, o.name, lines}, places, faults))
      all.push_back(make(o.name.empty() ? one->name : o.name, *one));
  }
  return all;
}

/// Whether the points of a line lie on the way from its first to its last.
bool is_straight(const MapLine& line) {
  const auto &a = line.front(), &b = line.back();
  const double x = b[0] - a[0], y = b[1] - a[1], squared = x * x + y * y;
  return squared > 0 && std::ranges::all_of(line, [&](const auto& point) {
           const double along = ((point[0] - a[0]) * x + (point[1] - a[1]) * y) / squared;
           const double aside = ((point[1] - a[1]) * x - (point[0] - a[0]) * y) / squared;
           return along >= -crooked && along <= 1 + crooked && std::abs(aside) <= crooked;
         });
}

void place_line(InflowOptions& o, std::size_t number, const std::vector<DomainPlace>& places,
                std::vector<Fault>& faults) {
  const Wish wish{"inflow", number, o.place, o.name, true};
  const Found found = found_by(wish, places, faults);
  if (found.empty()) return;
  if (found.size() > 1) {
    faults.push_back({fmt::format("{}: place \"{}\" has {} lines", wish.item(), o.place, found.size()),
                      "an inflow enters through one", "Give the name of one: " + names_of(found)});
    return;
  }
  const DomainPlace& one = *found.front();
  if (!is_straight(one.points)) {
    faults.push_back(
        {fmt::format("{}: the line \"{}\" of the place \"{}\" is not straight", wish.item(), one.name, one.place),
         "it enters through a straight line between two points",
         "Draw it straight across the channel, from bank to bank"});
    return;
  }
  if (o.name.empty()) o.name = one.name;
  o.line = {one.points.front(), one.points.back()};
  o.place.clear();
}

/// Adds a fault for every name that two items of a table have.
template <class Item>
void find_doubles(const char* table, const std::vector<Item>& items, std::vector<Fault>& faults) {
  std::set<std::string> names;
  for (const Item& item : items)
    if (!item.name.empty() && !names.insert(item.name).second)
      faults.push_back({fmt::format("[[solve.{}]]: two are called \"{}\"", table, item.name),
                        "numbers are recorded under names",
                        "Rename one, in the recipe or in the file of [[preprocess.place]]"});
}

template <class Item>
bool asks(const std::vector<Item>& items, const std::string& place) {
  return std::ranges::any_of(
      items, [&](const Item& item) { return place.empty() ? !item.place.empty() : item.place == place; });
}

/// Whether something of the options asks for a place; empty: for any.
bool asks(const SolveOptions& o, const std::string& place) {
  return asks(o.sections, place) || asks(o.gauges, place) || asks(o.inflows, place);
}

}  // namespace

SolveOptions with_places(SolveOptions o, const std::vector<DomainPlace>& places) {
  if (!asks(o, "")) return o;
  std::vector<Fault> faults;
  o.sections =
      placed(o.sections, "section", true, places, faults, [](const std::string& name, const DomainPlace& line) {
        return SectionOptions{.name = name, .line = line.points};
      });
  o.gauges = placed(o.gauges, "gauge", false, places, faults, [](const std::string& name, const DomainPlace& point) {
    return GaugeOptions{.name = name, .x = point.points[0][0], .y = point.points[0][1]};
  });
  for (std::size_t n = 0; n < o.inflows.size(); ++n)
    if (!o.inflows[n].place.empty()) place_line(o.inflows[n], n, places, faults);
  find_doubles("section", o.sections, faults);
  find_doubles("gauge", o.gauges, faults);
  find_doubles("inflow", o.inflows, faults);
  if (!faults.empty()) throw RecipeError(std::move(faults));
  return o;
}

std::vector<std::string> idle_places(const SolveOptions& asked, const std::vector<DomainPlace>& places) {
  std::vector<std::string> lines;
  std::set<std::string> said;
  for (const DomainPlace& one : places) {
    if (!said.insert(one.place).second || asks(asked, one.place)) continue;
    lines.push_back(
        fmt::format("[[preprocess.place]] \"{}\" is not asked for: give place = \"{}\" in "
                    "[[solve.section]], [[solve.gauge]] or [[solve.inflow]], or leave it out",
                    one.place, one.place));
  }
  return lines;
}

}  // namespace talus::solver
