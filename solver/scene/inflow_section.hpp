// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The section of ground that an inflow enters through: how deep and how fast a discharge fills it.
#pragma once

#include <vector>

#include "solver/options/inflow.hpp"

namespace talus::solver {

/// A flow through a section whose surface is level across it.
struct SectionFlow {
  double level = 0;  ///< of the surface, as the section's ground is measured [m]
  double area = 0;   ///< vertical, across the flow [m2]
  double width = 0;  ///< of what is covered, across the flow [m]
  double depth = 0;  ///< where it is deepest, vertical [m]
  double speed = 0;  ///< horizontal [m/s]
};

/// The ground along the line of an inflow, in strips of one width.
struct InflowGround {
  std::vector<double> height;  ///< of each strip [m]
  double strip = 0;            ///< width of one across the flow [m]
  double slope = 0;            ///< mean, along the flow; falling ground is negative [-]
  double gravity = 9.81;       ///< [m/s2]
};

/// The section of an inflow (T45), which fills like a channel: level across, over as much of the line as that takes.
class InflowSection {
 public:
  /// The constructor takes the ground, and which of speed, depth and Froude number is given.
  InflowSection(InflowGround ground, const InflowOptions& options);

  /// The flow of a discharge > 0 [m3/s].
  SectionFlow flow(double discharge) const;
  /// The vertical thickness of a flow over each strip [m].
  std::vector<double> thickness(const SectionFlow& flow) const;
  /// The Froude number of a flow: speed along the ground over sqrt(g cos(slope) h), h the mean depth normal to it [-].
  double froude(const SectionFlow& flow) const;
  /// The length along the ground over the horizontal one [-].
  double along() const;

 private:
  SectionFlow filled_to(double level) const;
  SectionFlow filled_by(double area) const;
  SectionFlow critical(double discharge, double froude) const;

  InflowGround ground_;
  std::vector<double> sorted_;  ///< heights of the strips, the lowest first [m]
  std::optional<double> speed_, depth_, froude_;
};

}  // namespace talus::solver
