// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/belief.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"

namespace talus::postprocess {
namespace {

/// With three figures: "21 900 m3".
std::string volume_text(double volume) {
  const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(std::max(volume, 1.0))) - 2));
  return grouped(fmt::format("{:.0f}", std::round(volume / unit) * unit), " ") + " m3";
}

/// What is said of the friction; `bed`: its law with the numbers, in brackets, or nothing.
std::string friction_text(const Options& options, const std::string& bed) {
  const auto friction = [&](const char* words) { return fmt::format("The friction{} {}", bed, words); };
  switch (options.friction_is) {
    case FrictionIs::given: return friction("is given from elsewhere and was not fitted to this event");
    case FrictionIs::guessed: return friction("is a guess, neither measured nor fitted");
    case FrictionIs::fitted: return friction("was fitted to this event, so that agreement with it is no test");
    case FrictionIs::not_said: break;
  }
  if (options.leaves_friction) return friction("is the program's default, a guess that nobody made for this slope");
  return friction("may be measured, guessed or fitted: the recipe does not say ([postprocess] friction_is)");
}

std::string inputs_text(const Run& run, const Options& options) {
  const RunSummary& s = run.summary;
  const std::string from = fact(s.provenance, volume_source), bed = s.bed.empty() ? "" : " (" + s.bed + ")";
  return fmt::format("{}; the volume of {} is {}.", friction_text(options, bed), volume_text(s.volume_released),
                     from.empty() ? "of a source that nothing names" : from);
}

/// "39 m short of", "at", "12 m beyond".
std::string distance_text(double difference) {
  const double metres = std::round(difference);
  if (metres == 0) return "within a metre of";
  return fmt::format("{:g} m {}", std::abs(metres), metres < 0 ? "short of" : "beyond");
}

std::string reach_text(const Options& options, const Survey* survey, const Score& score) {
  if (survey == nullptr) return "No survey says how far this run ends from what happened";
  const auto difference = score.number("runout_difference_m");
  if (!difference) return fmt::format("How far the run ends from \"{}\" is not known", survey->name);
  return fmt::format("The run's deposit (thicker than {:g} m) ends {} the end of \"{}\"{}", options.deposit_threshold,
                     distance_text(*difference), survey->name,
                     survey->kind == ReferenceKind::model ? ", which is another model's run" : "");
}

/// "2 warnings: coarse-grid of [preprocess], spikes of [preprocess] (2 times)"; advice is none.
std::string warnings_text(const Score& score) {
  std::vector<std::pair<std::string, int>> names;
  int count = 0;
  for (const Finding& finding : score.findings) {
    if (finding.severity == Severity::advice) continue;
    ++count;
    const bool refused = finding.severity == Severity::refusal;
    const std::string name = fmt::format("{} of [{}]{}", finding.name, finding.stage, refused ? ", accepted" : "");
    const auto known = std::ranges::find(names, name, [](const auto& one) { return one.first; });
    if (known == names.end())
      names.emplace_back(name, 1);
    else
      ++known->second;
  }
  if (count == 0) return "no stage warns of anything";
  std::vector<std::string> words;
  for (const auto& [name, times] : names)
    words.push_back(times == 1 ? name : fmt::format("{} ({} times)", name, times));
  return fmt::format("{} warning{}: {}", count, count == 1 ? "" : "s", fmt::join(words, "; "));
}

}  // namespace

std::vector<std::string> belief_of(const Run& run, const Options& options, const Survey* survey, const Score& score) {
  return {inputs_text(run, options), fmt::format("{}; {}.", reach_text(options, survey, score), warnings_text(score)),
          "One run is no forecast: this map may not be used by itself to call a place safe, to draw hazard zones or to "
          "design protection."};
}

}  // namespace talus::postprocess
