// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far a survey may be off.
#pragma once

#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// Fill survey.error as the options say; nothing where they give no sigma. Measured values without a sigma become NaN,
/// and a note says how many. Warns where the range of the errors is not known though surveys are to be drawn. Throws
/// DataError: unreadable file, other CRS, negative sigma.
void read_error(const SurveyOptions& options, const RunMaps& maps, Survey& survey);

}  // namespace talus::postprocess
