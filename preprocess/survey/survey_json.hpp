#pragma once

#include <optional>
#include <string>

#include "preprocess/survey/survey.hpp"

namespace talus::preprocess {

/// Alignment, error, variogram and volumes as JSON; keys carry their unit (docs/formats.md).
std::string survey_json(const Survey& survey, const Budgets& budgets, const std::optional<SurveyedSlide>& slide);

}  // namespace talus::preprocess
