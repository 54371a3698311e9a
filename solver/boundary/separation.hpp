// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Separation of the mass from its bed: which base nodes are held on the ground where they would leave it (T12c).
#pragma once

namespace talus {

/// What of the mass may leave its bed: all of it, none of it, or columns deeper than a threshold.
enum class Separation { free, none, thin };

/// The separation that a recipe chooses.
struct SeparationSettings {
  Separation kind = Separation::free;
  double depth = 0;  ///< columns shallower than this along the normal of the bed are held, with `thin` [m]
};

}  // namespace talus
