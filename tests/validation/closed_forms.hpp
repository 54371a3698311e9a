// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Solutions and laws that the cases are held against. Nothing here knows the solver.
#pragma once

namespace talus::validation {

/// How the uniaxial stress of a material without lateral strain follows its stretch (nu = 0).
///   corotated  first Piola stress E (stretch - 1): the paper's columns and the beams of the tables
///   hencky     Kirchhoff stress E ln(stretch)
enum class Law { corotated, hencky };

/// First Piola stress over E. The lateral stretch is one, so this is the Cauchy stress too.
double piola_of_stretch(Law law, double stretch);
/// Its inverse, for stress below the law's maximum (hencky: 1/e in tension).
double stretch_of_piola(Law law, double piola);
/// First Piola stress over E of a Kirchhoff stress over E (what run.h5 keeps).
double piola_of_kirchhoff(Law law, double kirchhoff);

/// A column under its own weight, its foot held, its sides on rollers. Reference coordinates count from the foot. The
/// first Piola stress is -weight (height - X) whatever the law (validation.md A1).
struct Column {
  Law law;
  double modulus;                                                  // E [Pa]
  double weight;                                                   // body force over reference volume [N/m3]
  double height;                                                   // [m]
  double piola(double x) const { return -weight * (height - x); }  // [Pa]
  double settlement(double x) const;                               // downwards [m]
};

/// Tip of a cantilever of length one with a dead load across it at the tip.
struct Tip {
  double across, along;  // w/L with the load, u/L towards the clamp
};

/// Inextensible and without shear strain (Bisshopp & Drucker 1945), k = P L^2 / (E I).
Tip elastica(double k);

/// Of a rectangular section `depth` deep (in lengths) that stretches, shears (coefficient 5/6, nu = 0) and whose fibres
/// follow `law`: what a fine three-dimensional computation converges to (Reissner 1972). With the deflected axis at
/// `points` places from clamp to tip where wanted.
struct AxisPoint {
  double x, w;
};
Tip solid_beam(double k, double depth, Law law, AxisPoint* axis = nullptr, int points = 0);

/// A block on an incline of `angle` [rad]: mu(v) = steady + (peak - steady) / (1 + v / characteristic) (Lucas, Mangeney
/// & Ampuero 2014); peak = steady is Coulomb.
struct SlidingBlock {
  double angle, peak, steady, characteristic = 1, gravity = 9.81;
  double acceleration(double speed) const;
  /// Way down the incline after `time`, from a first speed [m].
  double way(double speed, double time) const;
};

/// Ground that falls from `fall` to level as a parabola over `run`, or at 30 degrees into an arc of `radius` [m].
struct GroundLine {
  enum Kind { parabola, bend } kind;
  double fall, run, radius;
  double elevation(double x) const;
  /// Where a point stops that starts at rest from x, with Coulomb friction mu, pressed on by the ground's curvature as
  /// well: d(v^2)/ds = 2 g (sin t - mu cos t) - 2 mu v^2 dt/ds.
  double reach(double x, double mu) const;
};

/// A cap h = depth (1 - r^2 / radius^2) that slides down a plane and spreads (Hutter, Siegel, Savage & Nohguchi 1993,
/// with as much stress along the slope as across it): it stays a paraboloid, f times as wide, f'' = 2 g cos(slope)
/// depth / (radius^2 f^3). Angles in rad.
struct ParabolicCap {
  double slope, bed, depth, radius, gravity = 9.81;
  struct State {
    double way, speed;     // of the middle, down the slope [m], [m/s]
    double width, spread;  // f, f' [1/s]
  };
  State at(double time) const;
  /// Across the slope, `along` and `across` from where the middle began [m].
  double thickness(const State& s, double along, double across) const;
};

/// A layer upslope of x = 0 that lets go at once (Mangeney, Heinrich & Roche 2000): depth-averaged, Coulomb on its bed,
/// as much stress along the slope as across it. Angles in rad, x along the slope downhill, depth across it [m].
struct DamBreak {
  double slope, bed, depth, gravity = 9.81;
  double thickness(double x, double time) const;  ///< across the slope [m]
  double speed(double x, double time) const;      ///< downhill [m/s]; 0 where there is nothing
};

/// Slope of the straight line through (ln x, ln y).
double observed_order(const double* x, const double* y, int count);

// What laboratories found of columns of sand that collapse onto a level floor. Run-outs are (d_inf - d_0) / d_0,
// heights h_inf / d_0, d_0 the width of the column (or its radius), over the aspect ratio height by width.

/// The run-out in a channel by Lube, Huppert, Sparks & Freundt (2005); NaN between 1.8 and 2.8, where they give no law.
double lube_run_out(double aspect);
/// The height in a channel by the same.
double lube_height(double aspect);
/// The run-out in a wide channel by Lajeunesse, Monnier & Homsy (2005).
double lajeunesse_run_out(double aspect);
/// The height in a wide channel by the same.
double lajeunesse_height(double aspect);
/// The run-out of a round column by Lube, Huppert, Sparks & Hallworth (2004).
double round_run_out(double aspect);
/// The height of a round column by the same; NaN between 1 and 1.7, where they give no law.
double round_height(double aspect);

/// What a result may be.
struct Band {
  double low, high;
};
/// From 0.9 times the smaller to 1.1 times the larger of two laws; a law that is NaN has no say. Laboratories differ by
/// up to a third, and each fit scatters by about a tenth.
Band band_of(double one, double other);

}  // namespace talus::validation
