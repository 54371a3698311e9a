// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the draws of a calibration leave unexplained.
#pragma once

#include <vector>

#include "postprocess/ensemble/ensemble.hpp"

namespace talus::postprocess {

/// The surveyed thickness less the mean of the draws, over the standard deviation that both are expected to differ by:
/// the survey's error, the model's discrepancy (likelihood.json) and the spread of the draws. On the cells of the run;
/// NaN where nothing was surveyed or neither is thicker than the threshold. Empty where the members are no draws of a
/// calibration, or no thickness was compared.
std::vector<double> residual_in_sigma(const Ensemble& ensemble, const std::optional<Survey>& survey,
                                      const MemberRows& rows, const Options& options);

}  // namespace talus::postprocess
