// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/survey/found_survey.hpp"

#include <nlohmann/json.hpp>
#include <optional>

#include "common/stage/findings.hpp"
#include "common/stage/input_file.hpp"

namespace talus::postprocess {

namespace {

using Json = nlohmann::json;

std::filesystem::path file_in(const std::filesystem::path& out) { return out / "survey" / "survey.json"; }

/// The file, null where there is none, discarded where it is no JSON.
Json read_json(const std::filesystem::path& out) {
  const std::optional<std::string> text = text_if_there(file_in(out));
  return text ? Json::parse(*text, nullptr, false) : Json(nullptr);
}

Json table(const Json& in, const char* key) {
  return in.is_object() && in.contains(key) && in.at(key).is_object() ? in.at(key) : Json::object();
}

bool flag(const Json& in, const char* key, bool otherwise) {
  return in.contains(key) && in.at(key).is_boolean() ? in.at(key).get<bool>() : otherwise;
}

std::string word_in(const Json& in, const char* key) {
  return in.contains(key) && in.at(key).is_string() ? in.at(key).get<std::string>() : "";
}

bool error_known(const Json& json) { return flag(table(json, "error"), "known", true); }

}  // namespace

FoundSurvey read_found_survey(const std::filesystem::path& out) {
  const Json json = read_json(out);
  if (json.is_null()) return {};
  if (!json.is_object())
    throw DataError(
        {file_in(out).string() + ": it is no JSON", "it was cut short or edited", "Run talus-preprocess again"});
  const Json outside = table(json, "outside_slide");
  FoundSurvey found{error_known(json), flag(outside, "large", false), flag(outside, "doubtful", false), ""};
  if (outside.contains("words") && outside.at("words").is_string())
    found.outside_words = outside.at("words").get<std::string>();
  found.id = word_in(json, "id");
  found.recipe_mark = word_in(json, "recipe");
  return found;
}

bool lacks_error(const std::filesystem::path& out) { return !error_known(read_json(out)); }

void judge_outside(const FoundSurvey& found, const std::filesystem::path& out) {
  if (!found.outside_is_large) return;
  refuse_unless_accepted("change-outside-slide",
                         {file_in(out).string() + ": " + found.outside_words,
                          "the surveyed deposit, and every score against it, would lack what belongs to the slide",
                          "Look at survey/survey.qgs, set these keys, and run talus-preprocess again"});
}

void require_whole_survey(const std::filesystem::path& out) {
  const std::filesystem::path file = out / "survey" / "survey.json";
  if (!std::filesystem::exists(out / "survey" / "slide_difference.tif") || std::filesystem::exists(file)) return;
  throw DataError({file.string() + ": no such file",
                   "talus-preprocess writes it last; without it what lies beside it may be of two preparations",
                   "Run talus-preprocess again"});
}

}  // namespace talus::postprocess
