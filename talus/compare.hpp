// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus compare: two runs on one page.
#pragma once

#include "talus/request.hpp"

namespace talus::command {

/// Compares the runs in two folders of results: talus-postprocess --against writes FIRST/comparison.html. Returns its
/// exit code. Throws DataError where one of the folders holds no run.
int compare_runs(const std::filesystem::path& first, const std::filesystem::path& second, const Request& request);

}  // namespace talus::command
