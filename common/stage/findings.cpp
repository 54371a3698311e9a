// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/recipe/paths.hpp"
#include "common/stage/stage.hpp"
#include "common/text_encoding.hpp"

namespace talus {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* severities[] = {"advice", "warning", "refusal"};

thread_local Findings* innermost = nullptr;

void log_finding(const Finding& finding) {
  if (finding.severity == Severity::advice) return log_advice(finding.message);
  const bool accepted = finding.severity == Severity::refusal;
  log_warning((accepted ? fmt::format("accepted, \"{}\": ", finding.name) : "") + finding.message);
}

Json json_of(const Finding& f) {
  Json json{{"severity", word_of(f.severity)}, {"name", f.name}, {"message", f.message}};
  json["numbers"] = Json::object();
  for (const FindingNumber& number : f.numbers)
    json["numbers"][number.name] = {{"value", std::isfinite(number.value) ? Json(number.value) : Json(nullptr)},
                                    {"unit", number.unit}};
  json["stage"] = f.stage;
  json["accepted_by"] = f.accepted_by.empty() ? Json(nullptr) : Json(f.accepted_by);
  if (f.member != Finding::no_member) json["member"] = f.member;
  return json;
}

/// None, or an exception of the library, where the JSON is of something else.
std::optional<Finding> finding_of(const Json& json) {
  const auto* const severity = std::ranges::find(severities, json.at("severity").get<std::string>());
  if (severity == std::end(severities)) return std::nullopt;
  Finding f{static_cast<Severity>(severity - severities), json.at("name").get<std::string>(),
            json.at("message").get<std::string>()};
  for (const auto& [name, number] : json.at("numbers").items()) {
    const Json& value = number.at("value");
    f.numbers.push_back({name, value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>(),
                         number.at("unit").get<std::string>()});
  }
  f.stage = json.at("stage").get<std::string>();
  if (!json.at("accepted_by").is_null()) f.accepted_by = json.at("accepted_by").get<std::string>();
  if (json.contains("member")) f.member = json.at("member").get<std::int64_t>();
  return f;
}

}  // namespace

Findings::Findings(std::string stage, std::vector<std::string> accept, Log log)
    : stage_(std::move(stage)),
      accept_(std::move(accept)),
      passes_on_(log == Log::now),
      kept_back_(!passes_on_ || log_is_kept_back()),
      outer_(std::exchange(innermost, this)) {}

Findings::~Findings() { innermost = outer_; }

void Findings::settle() {
  if (!refused_.empty()) throw DataError(std::exchange(refused_, {}));
}

void Findings::keep(const Finding& finding) {
  for (Findings* list = innermost; list != nullptr; list = list->passes_on_ ? list->outer_ : nullptr)
    list->list_.push_back(finding);
}

void add_finding(Finding finding) {
  finding.message = with_short_numbers(as_utf8(with_shown_paths(finding.message)));
  if (finding.stage.empty() && innermost != nullptr) finding.stage = innermost->stage_;
  if (innermost != nullptr && std::ranges::find(innermost->list_, finding) != innermost->list_.end()) return;
  if (!log_is_kept_back()) log_finding(finding);
  Findings::keep(finding);
}

void add_findings(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) Findings::keep(finding);
}

void advise(std::string name, std::string message, std::vector<FindingNumber> numbers) {
  add_finding({Severity::advice, std::move(name), std::move(message), std::move(numbers)});
}

void warn(std::string name, std::string message, std::vector<FindingNumber> numbers) {
  add_finding({Severity::warning, std::move(name), std::move(message), std::move(numbers)});
}

void refuse_unless_accepted(const std::string& name, const Fault& fault, std::vector<FindingNumber> numbers) {
  const std::string stage = innermost == nullptr ? "" : innermost->stage_;
  if (innermost == nullptr || std::ranges::find(innermost->accept_, name) == innermost->accept_.end()) {
    const Fault refused{fault.what, fault.why,
                        fmt::format("{}. To insist on it: accept = [\"{}\"] in [{}]", fault.mend, name, stage)};
    if (innermost == nullptr) throw DataError(refused);
    innermost->refused_.push_back(refused);
    return;
  }
  if (is_accepted(innermost->list_, name)) return;
  add_finding({Severity::refusal, name, to_string({fault.what, fault.why, ""}), std::move(numbers), stage,
               fmt::format("accept in [{}]", stage)});
}

void settle_findings() {
  if (innermost != nullptr) innermost->settle();
}

std::vector<Finding> findings_so_far() {
  const Findings* list = innermost;
  while (list != nullptr && list->passes_on_ && list->outer_ != nullptr) list = list->outer_;
  return list == nullptr ? std::vector<Finding>{} : list->list_;
}

void warn_of_unused(const std::string& stage, const std::vector<std::string>& accept,
                    const std::vector<Finding>& findings) {
  for (const std::string& name : accept)
    if (!is_accepted(findings, name))
      warn("unused-accept",
           fmt::format("[{}]: accept = [\"{}\"]: there was nothing of the kind to accept; leave it out, so that it is "
                       "refused should it come",
                       stage, name));
}

bool log_is_kept_back() { return innermost != nullptr && innermost->kept_back_; }

bool is_accepted(const std::vector<Finding>& findings, const std::string& name) {
  return std::ranges::any_of(findings,
                             [&](const Finding& f) { return f.severity == Severity::refusal && f.name == name; });
}

std::string accepted_line(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& f : findings)
    if (f.severity == Severity::refusal) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", f.name, f.message);
  return text;
}

std::string to_json(const std::vector<Finding>& findings) {
  Json json = Json::array();
  for (const Finding& finding : findings) json.push_back(json_of(finding));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<std::vector<Finding>> findings_in(const std::string& text) {
  std::vector<Finding> findings;
  try {
    const Json json = Json::parse(text);
    if (!json.is_array()) return std::nullopt;
    for (const Json& one : json) {
      auto finding = finding_of(one);
      if (!finding) return std::nullopt;
      findings.push_back(std::move(*finding));
    }
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  return findings;
}

const char* word_of(Severity severity) { return severities[static_cast<std::size_t>(severity)]; }

}  // namespace talus
