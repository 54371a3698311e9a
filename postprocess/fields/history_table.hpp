// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// Time series of the run as comma-separated values, a row for every record, time first.
std::string history_table(const RunHistory& history);

}  // namespace talus::postprocess
