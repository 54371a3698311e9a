// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The sanity of a run at its end: its volume, packing, energy and speed against what a slide can have.
#pragma once

#include "common/run/run_file.hpp"
#include "common/stage/findings.hpp"
#include "solver/run/products.hpp"

namespace talus::solver {

/// Bounds of what is sane; beyond them a run says so. The reasons stand in docs/notes/plausibility.md.
struct SanityBounds {
  double volume_error = 1e-6;  ///< volumes in single precision are exact to 6e-8
  double volume_left = 0.5;    ///< beyond it the map shows less than half of the slide
  double packing_p99 = 4;      ///< a quarter above the worst of the samples and real events
  double energy_gain = 0.02;   ///< of what was turned over
  double speed_share = 1.05;   ///< of the speed of a fall without loss
};

/// The function measures a run at its end from its history, its maps and its points at the start. `outflow` is what
/// left the domain [m3].
RunSanity sanity_of(const RunEnd& end, const RunHistory& history, double outflow);

/// Warnings of what is beyond its bound; none where nothing is.
std::vector<Finding> insane(const RunSanity& sanity, const SanityBounds& bounds = {});

/// Logs one line with all numbers, and adds the warnings.
void say_sanity(const RunSanity& sanity);

}  // namespace talus::solver
