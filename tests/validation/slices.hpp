// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The factor of safety of simple slopes by slices: Bishop's simplified method (Bishop 1955) on the circle on which it
// is least, which is how Bishop & Morgenstern (1960) made their charts. Nothing here knows the solver.
#pragma once

namespace talus::validation {

/// A plane face of height one between level ground, on a firm base. Stresses in unit weight times height.
struct EarthSlope {
  double cotangent = 2;  ///< of the face
  double cohesion = 0;   ///< [-]
  double friction = 0;   ///< angle [degrees]
  double water = 0;      ///< r_u: pore pressure over the weight of the ground above
  double base = 1;       ///< depth of the firm base below the crest
};

/// A circle: its centre, x from the toe towards the crest and y up from the toe, and its lowest level.
struct SlipCircle {
  double x = 0, y = 0, low = 0;
};

/// The factor of safety on a circle; infinity where it cuts no slope that slides, or passes below the base.
double bishop_factor(const EarthSlope& slope, const SlipCircle& circle);

/// The least of them, to about 0.1 %: a grid of circles, and the best of them moved until none beside is worse.
double bishop_factor(const EarthSlope& slope);

}  // namespace talus::validation
