// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus check: every fault of all stages in one listing.
#pragma once

#include "talus/request.hpp"

namespace talus::command {

/// Checks the tables of all stages, then, as far as they go together, the data and the physics: the domain is prepared
/// in a folder of its own that goes again, unless the one in the results is up to date. Prints the faults and warnings
/// on stderr; writes nothing into the results. Returns 0, or the largest exit code of a stage.
int check_scene(const Request& request);

}  // namespace talus::command
