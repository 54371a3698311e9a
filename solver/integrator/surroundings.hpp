// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// All that the mass can touch: bed, walls, and surfaces between the nodes.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/boundary/contact_impulses.hpp"
#include "solver/boundary/plane_walls.hpp"
#include "solver/boundary/surface_contact.hpp"
#include "solver/integrator/device_bed.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/settings.hpp"

namespace talus::solver {

/// The surroundings of the mass on a device: they do not move with it, and remember what they gave to it.
template <class Real, class Device, class Shape>
class Surroundings {
 public:
  using Contact = SurfaceContact<Real, Device, Shape>;    ///< the surfaces between the nodes
  using Impulses = ContactImpulses<Real, Device, Shape>;  ///< what they give in velocities

  /// The constructor takes bed, walls and contact points of a scene, whose lowest ground is at `datum` [m], and what
  /// the contact points gave before.
  Surroundings(const Device& device, const Scene& scene, const IntegratorSettings& settings, const ContactState& state,
               double datum)
      : bed_(device, settings.bed, scene.bed),
        walls_(settings.walls),
        frame_{{scene.map.x(0), scene.map.y(0), datum},
               {scene.grid.spacing, scene.grid.spacing, scene.grid.layer_height}},
        contact_(device, scene.contacts, scene.grid, state, settings.deterministic),
        impulses_(device) {}

  /// The bed's friction as kernels see it.
  BaseFriction<Real> bed() const { return bed_.view(); }
  /// The walls that are there at a time [s], as kernels see them.
  template <class Number>
  Walls<Number> walls(double time) const {
    return walls_at<Number>(walls_, time, frame_);
  }
  /// The surfaces between the nodes.
  Contact& contact() { return contact_; }
  /// The surfaces between the nodes, to read from.
  const Contact& contact() const { return contact_; }
  /// The sweeps in which those surfaces give impulses to the nodes.
  Impulses& impulses() { return impulses_; }

  /// The size of the bed's numbers [bytes].
  std::size_t bed_bytes() const { return bed_.bytes(); }
  /// The size of what belongs to the contact points [bytes].
  std::size_t contact_bytes() const { return contact_.bytes() + impulses_.bytes(); }

 private:
  DeviceBed<Real, Device> bed_;
  std::vector<PlaneWall> walls_;
  WallFrame frame_;
  Contact contact_;
  Impulses impulses_;
};

}  // namespace talus::solver
