// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What run.h5 says about itself, without its maps and points.
#pragma once

#include <filesystem>

#include "common/stage/identity.hpp"

namespace talus {

/// The provenance of a run. Throws DataError: missing, damaged.
Facts run_facts(const std::filesystem::path& file);

}  // namespace talus
