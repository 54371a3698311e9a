// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What laboratories found of columns of sand that collapse onto a level floor. Run-outs are (d_inf - d_0) / d_0,
// heights h_inf / d_0, d_0 the width of the column (or its radius), over the aspect ratio height by width.
#pragma once

namespace talus::validation {

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
