// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What run.h5 says about itself, without its maps and points.
#pragma once

#include <filesystem>

#include "common/stage/identity.hpp"

namespace talus {

namespace h5 {
class File;
}

/// The provenance of a run. Throws DataError: missing, damaged.
Facts run_facts(const std::filesystem::path& file);

/// The same, of a file that is open.
Facts run_facts(const h5::File& file);

}  // namespace talus
