// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// score.json and score.txt from the same entries.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "postprocess/score/score.hpp"

#include "common/map/sum.hpp"

namespace talus::postprocess {
namespace {

/// With thousands set apart by spaces, as in SI.
std::string value_text(const ScoreEntry& entry) {
  if (const auto* text = std::get_if<std::string>(&entry.value)) return *text;
  if (const auto* count = std::get_if<std::int64_t>(&entry.value)) return grouped(fmt::format("{}", *count), " ");
  const double value = std::get<double>(entry.value);
  if (entry.decimals > 6) return fmt::format("{:.1e}", value);  // a closure error: its size matters, not its digits
  const auto plain = fmt::format("{:.{}f}", value, entry.decimals);
  const bool rounds_to_zero = plain.find_first_not_of("-0.") == std::string::npos;
  return grouped(rounds_to_zero ? fmt::format("{:.{}f}", 0.0, entry.decimals) : plain, " ");
}

bool is_text(const ScoreEntry& entry) { return std::holds_alternative<std::string>(entry.value); }

/// How a finding begins: "Warning of [solve],".
std::string heading_of(const Finding& finding) {
  const char* const words[] = {"Advice", "Warning", "Refused and accepted"};
  return fmt::format("{} in [{}],", words[static_cast<std::size_t>(finding.severity)], finding.stage);
}

/// Break at spaces so that no line is longer than `width`.
std::string wrapped(const std::string& text, std::size_t width, const std::string& indent) {
  std::string lines, line;
  for (std::size_t start = 0; start < text.size();) {
    const auto end = std::min(text.find(' ', start), text.size());
    const auto word = text.substr(start, end - start);
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      lines.append(line).append("\n").append(indent);
      line = word;
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
    start = end + 1;
  }
  return lines + line;
}

}  // namespace

std::string to_json(const Score& score) {
  nlohmann::ordered_json json;
  json["title"] = score.title;
  for (const auto& section : score.sections) {
    for (const auto& entry : section.entries)
      std::visit([&](const auto& value) { json[entry.key] = value; }, entry.value);
  }
  auto& absent = json["not_scored"] = nlohmann::ordered_json::object();
  for (const auto& [key, why] : score.not_scored) absent[key] = why;
  json["findings"] = nlohmann::ordered_json::parse(to_json(score.findings));
  json["notes"] = score.notes;
  return json.dump(2) + "\n";
}

std::string to_table(const Score& score) {
  std::size_t label_width = 0, value_width = 0;
  for (const auto& section : score.sections) {
    for (const auto& entry : section.entries) {
      label_width = std::max(label_width, entry.label.size());
      if (!is_text(entry)) value_width = std::max(value_width, value_text(entry).size());
    }
  }
  std::string text = score.title + "\n" + std::string(score.title.size(), '=') + "\n";
  for (const auto& section : score.sections) {
    text += "\n" + section.title + "\n";
    for (const auto& entry : section.entries) {
      const auto value = value_text(entry);
      text += is_text(entry) ? fmt::format("  {:<{}}  {}\n", entry.label, label_width, value)
                             : fmt::format("  {:<{}}  {:>{}}{}{}\n", entry.label, label_width, value, value_width,
                                           entry.unit.empty() ? "" : " ", entry.unit);
    }
  }
  if (!score.not_scored.empty()) text += "\nNot scored\n";
  for (const auto& [key, why] : score.not_scored) text += fmt::format("  {:<{}}  {}\n", key, label_width, why);
  if (!score.findings.empty()) text += "\nFindings\n";
  for (const Finding& f : score.findings)
    text += "- " + wrapped(fmt::format("{} \"{}\": {}", heading_of(f), f.name, f.message), 110, "  ") + "\n";
  text += "\n";
  for (const auto& note : score.notes) text += "- " + wrapped(note, 110, "  ") + "\n";
  return text;
}

}  // namespace talus::postprocess
