// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points where the kernels run (see contact_points.hpp): what they gave so far, and how kernels go over those
// beside the mass.
#pragma once

#include <vector>

#include "solver/boundary/contact_arrays.hpp"
#include "solver/boundary/nearby_contacts.hpp"
#include "solver/grid/terrain.hpp"
#include "solver/parallel/algorithms.hpp"

namespace talus::solver {

/// One thread: one contact point. It forgets its force where the mass has left its block and those around it.
template <class Real>
struct ForgetForces {
  GridView<Real> grid;
  ContactView<Real> contacts;
  TALUS_HD void operator()(int c) const {
    const int x = contacts.places.cell[0][c] >> 2, y = contacts.places.cell[1][c] >> 2;
    const int across = grid.block_columns_x, rows = blocks_across(grid.rows);
    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < rows; ++j) {
      for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < across; ++i) {
        if (grid.slots[j * across + i].offset >= 0) return;
      }
    }
    contacts.force[c] = {};
    contacts.inverse_mass[c] = Real(0);
  }
};

/// The contact points on a device with their history.
template <class Real, class Device, class Shape>
class SurfaceContact {
 public:
  /// The constructor takes the points of a grid of this shape, and what they gave before; with `in_order` sums are the
  /// same on every run on a GPU too.
  SurfaceContact(const Device& device, const ContactPoints& points, const GridShape& shape, const ContactState& state,
                 bool in_order)
      : device_(device),
        bodies_(points.body),
        obstacles_(points.friction.size()),
        arrays_(device, points, state),
        nearby_(device, points, shape.columns, shape.rows, in_order) {}

  /// Whether there are contact points.
  bool on() const { return count() > 0; }
  /// The number of contact points.
  int count() const { return nearby_.count(); }

  /// The contact points as kernels see them.
  ContactView<Real> view() { return arrays_.view(); }

  /// The method lists the contact points beside the mass, once the grid has been fitted to it.
  template <class Grid>
  void fit(const Grid& grid) {
    if (!on()) return;
    std::vector<int> active(static_cast<std::size_t>(grid.active_blocks()));
    copy_to_host(device_, active.data(), grid.active_list(), active.size() * sizeof(int));
    nearby_.fit(active);
    for_each(device_, count(), ForgetForces<Real>{grid.view(), view()});
  }

  /// The method runs kernel(c) for every contact point of the blocks in use, such that scatter_add never meets itself.
  template <class Kernel>
  void each(const Kernel& kernel) const {
    nearby_.each(kernel);
  }

  /// The impulse that every obstacle was given so far, [obstacles] [N s].
  std::vector<Vec3<double>> obstacle_impulses() const {
    std::vector<Vec3<double>> sums(obstacles_);
    const std::vector<Vec3<double>> impulses = arrays_.impulses();
    for (std::size_t c = 0; c < impulses.size(); ++c) sums[static_cast<std::size_t>(bodies_[c])] += impulses[c] * -1.0;
    return sums;
  }

  /// The forces and impulses that a checkpoint keeps.
  ContactState state() const { return arrays_.state(); }

  /// The size of the arrays [bytes].
  std::size_t bytes() const { return arrays_.bytes() + nearby_.bytes(); }

 private:
  Device device_;
  std::vector<int> bodies_;
  std::size_t obstacles_;
  ContactArrays<Real, Device> arrays_;
  NearbyContacts<Device> nearby_;
};

}  // namespace talus::solver
