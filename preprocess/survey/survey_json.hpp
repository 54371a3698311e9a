// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "common/stage/identity.hpp"
#include "preprocess/survey/survey.hpp"

namespace talus::preprocess {

/// Alignment, error, variogram and volumes as JSON; keys carry their unit (docs/reference/formats.md). `marks` are
/// those of the preparation (identity.hpp).
std::string survey_json(const Survey& survey, const Budgets& budgets, const std::optional<SurveyedSlide>& slide,
                        const Facts& marks = {});

}  // namespace talus::preprocess
