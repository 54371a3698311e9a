// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Members of an ensemble whose whole run is kept.
#pragma once

#include "common/ensemble/counts.hpp"
#include "common/ensemble/names.hpp"
#include "common/ensemble/options.hpp"
#include "common/stage/stage.hpp"
#include "solver/ensemble/members.hpp"
#include "solver/parallel/any_device.hpp"

namespace talus::solver {

/// This function runs the members of `counts` that wait and that the recipe keeps, one after another, each into a
/// folder of its own with run.h5 as a run alone leaves it. They are counted later with the others. It adds to the
/// results.
void keep_runs(StageContext& context, const Members& members, const EnsembleOptions& options,
               const EnsemblePaths& paths, const AnyDevice& device, const EnsembleCounts& counts);

}  // namespace talus::solver
