// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The stage talus-solve: domain.vdb -> run.h5; members.h5 -> counts.h5; budget/ -> budget.h5.
#pragma once

#include <future>

#include "common/stage/stage.hpp"

namespace talus::solver {

/// The stage with flags of its own: each call of the function makes another set of flags.
Stage stage();

/// Begins to make the context of the GPU for a recipe, where there is a GPU: that takes longer than to prepare many a
/// scene. The future waits for it.
std::future<void> begin_gpu(const recipe::Recipe& recipe);

/// Ends the process with this exit code, once all files are closed. Where a GPU was used it ends at once: to take the
/// GPU's context apart takes longer than many runs, and the system does so in any case.
[[noreturn]] void end_process(int code);

}  // namespace talus::solver
