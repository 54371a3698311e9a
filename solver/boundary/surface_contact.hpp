// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points where the kernels run (see contact_points.hpp): the mass before them and the law of contact, what they
// gave so far, and how kernels go over those beside the mass.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "solver/boundary/contact_points.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus::solver {

/// The contact points as kernels see them.
template <class Real>
struct ContactView {
  ParticleView<Real> places;  ///< cells and offsets, nothing else
  const Vec3<Real>* normal;
  const Real* area;  ///< [m2]
  const int* body;
  const Real* body_friction;  ///< coefficient of each obstacle
  Real* inverse_mass;         ///< of the mass before it in this step [1/kg]; 0: there is none
  Vec3<double>* force;        ///< see ContactState
  Vec3<double>* impulse;

  /// The method calls f(node, share) for the nodes with any mass around point c, which the mass is before. Shares M_ic
  /// of (T12a) are weights times masses over their sum: they add up to one, and an impulse at the point changes the
  /// velocity of a node with next to no mass by no more than that of the others.
  template <class Shape, class Nodes, class F>
  TALUS_HD void around(const GridView<Real>& grid, const Nodes& nodes, int c, F&& f) const {
    const Stencil<Real, Shape> s(grid, places, c);
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a) {
        for (int d = 0; d < Shape::width; ++d) {
          const int n = grid.find(s.i + a, s.j + b, s.k + d > 0 ? s.k + d : 0);
          if (n < 0) continue;
          const Real share = s.wx[a] * s.wy[b] * s.wz[d] * nodes.mass(n) * inverse_mass[c];
          if (share > Real(0)) f(n, share);
        }
      }
    }
  }

  /// The mass before point c by weight [kg], 0 where that falls off along the normal. A surface stops what comes from
  /// the side it looks to, not what a wall thinner than a cell keeps on its other side, whose nodes are the same.
  template <class Shape, class Nodes>
  TALUS_HD Real mass_before(const GridView<Real>& grid, const Nodes& nodes, int c) const {
    const Stencil<Real, Shape> s(grid, places, c);
    const Vec3<Real> n = normal[c];
    const Real across = Real(1) / grid.spacing, up = (n.z - n.x * s.slope_x - n.y * s.slope_y) / grid.layer_height;
    Real mass = 0, rise = 0;
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a) {
        const Real along = (n.x * s.gx[a] * s.wy[b] + n.y * s.wx[a] * s.gy[b]) * across, plain = s.wx[a] * s.wy[b];
        for (int d = 0; d < Shape::width; ++d) {
          const int node = grid.find(s.i + a, s.j + b, s.k + d > 0 ? s.k + d : 0);
          if (node < 0) continue;
          const Real m = nodes.mass(node);
          mass += plain * s.wz[d] * m;
          rise += (along * s.wz[d] + up * plain * s.gz[d]) * m;
        }
      }
    }
    return rise * grid.spacing > Real(-0.5) * mass ? mass : Real(0);
  }

  /// The ratio of friction to normal force at contact point c.
  TALUS_HD Real friction(int c) const { return body_friction[body[c]]; }

  /// The share to which the surface at point c is covered: a layer's worth of mass makes it a full one, of which half
  /// lies within the weights of a point on a surface.
  TALUS_HD Real filled(const GridView<Real>& grid, int c, double layer_mass) const {
    const Real share = Real(1) / (inverse_mass[c] * Real(0.5 * layer_mass) * grid.spacing * grid.spacing);
    return share < Real(1) ? share : Real(1);
  }

  /// The force or impulse that the surface can give towards the `required` one, H of (T12a): it pushes, and holds
  /// back slip up to `coefficient` times the push.
  TALUS_HD static Vec3<Real> hold(const Vec3<Real>& required, const Vec3<Real>& normal, Real coefficient) {
    const Real push = dot(required, normal);
    if (!(push > Real(0))) return {};
    const Vec3<Real> along = required - normal * push;
    const Real size = length(along), limit = coefficient * push;
    return size > limit ? normal * push + along * (limit / size) : required;
  }
};

/// The arrays of the contact points, all of one length: place, normal, area and body, and the history of checkpoints.
template <class Real, class Device>
class ContactArrays {
 public:
  /// Copies the points to the device, with forces and impulses from `state`, zero where it is empty.
  ContactArrays(const Device& device, const ContactPoints& points, const ContactState& state)
      : cell_(device),
        offset_(device),
        extent_(device),
        normal_(device),
        area_(device),
        body_(device),
        body_friction_(device),
        inverse_mass_(device),
        force_(device),
        impulse_(device) {
    for (std::size_t a = 0; a < 3; ++a) {
      cell_[a].upload(points.cell[a]);
      upload_as(offset_[a], points.offset[a]);
    }
    extent_.upload(std::vector<Real>(points.size()));
    std::vector<Vec3<Real>> normals;
    for (const Vec3<double>& n : points.normal)
      normals.push_back({static_cast<Real>(n.x), static_cast<Real>(n.y), static_cast<Real>(n.z)});
    normal_.upload(normals);
    upload_as(area_, points.area);
    body_.upload(points.body);
    upload_as(body_friction_, points.friction);
    inverse_mass_.upload(std::vector<Real>(points.size()));
    upload_vectors(force_, state.force, points.size());
    upload_vectors(impulse_, state.impulse, points.size());
  }

  /// The contact points as kernels see them.
  ContactView<Real> view() {
    ContactView<Real> v{};
    for (std::size_t a = 0; a < 3; ++a) {
      v.places.cell[a] = cell_[a].data();
      v.places.offset[a] = offset_[a].data();
      v.places.extent[a] = extent_.data();
    }
    v.normal = normal_.data();
    v.area = area_.data();
    v.body = body_.data();
    v.body_friction = body_friction_.data();
    v.inverse_mass = inverse_mass_.data();
    v.force = force_.data();
    v.impulse = impulse_.data();
    return v;
  }

  /// The impulse that every point gave to the mass so far, [points] [N s]; waits for the device.
  std::vector<Vec3<double>> impulses() const { return impulse_.download(); }

  /// The forces and impulses that a checkpoint keeps.
  ContactState state() const { return {download_vectors(force_), download_vectors(impulse_)}; }

  std::size_t bytes() const {
    std::size_t total = bytes_of(extent_, normal_, area_, body_, body_friction_, force_, impulse_, inverse_mass_);
    for (std::size_t a = 0; a < 3; ++a) total += bytes_of(cell_[a], offset_[a]);
    return total;
  }

 private:
  static void upload_vectors(Buffer<Vec3<double>, Device>& to, const std::vector<double>& from, std::size_t count) {
    std::vector<Vec3<double>> vectors(count);
    for (std::size_t c = 0; 3 * c + 2 < from.size() && c < vectors.size(); ++c)
      vectors[c] = {from[3 * c], from[3 * c + 1], from[3 * c + 2]};
    to.upload(vectors);
  }
  static std::vector<double> download_vectors(const Buffer<Vec3<double>, Device>& from) {
    std::vector<double> numbers;
    for (const Vec3<double>& v : from.download()) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return numbers;
  }

  Buffers<int, Device, 3> cell_;
  Buffers<Real, Device, 3> offset_;
  Buffer<Real, Device> extent_;  ///< of a box without size
  Buffer<Vec3<Real>, Device> normal_;
  Buffer<Real, Device> area_;
  Buffer<int, Device> body_;
  Buffer<Real, Device> body_friction_;  ///< [obstacles]
  Buffer<Real, Device> inverse_mass_;
  Buffer<Vec3<double>, Device> force_, impulse_;
};

/// One thread: one contact point of the list.
template <class Kernel>
struct OverList {
  using Named = Kernel;
  Kernel kernel;
  const int* list;
  TALUS_HD void operator()(int t) const { kernel(list[t]); }
};

/// The choice of contact points that kernels are run for. A GPU goes over a list of them, all at once; the CPU, and a
/// GPU whose sums must not depend on the run, over ranges in four colours.
template <class Device>
class NearbyContacts {
 public:
  /// Takes the points, sorted by block, and the size of the map [nodes]; none of them is near until the first fit().
  NearbyContacts(const Device& device, const ContactPoints& points, int columns, int rows, bool in_order)
      : device_(device), count_(static_cast<int>(points.size())), blocks_x_(blocks_across(columns)), list_(device) {
    groups_.in_order = in_order;
    first_.assign(static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_across(rows)) + 1, 0);
    for (std::size_t c = 0; c < points.size(); ++c)
      ++first_[static_cast<std::size_t>((points.cell[1][c] >> 2) * blocks_x_ + (points.cell[0][c] >> 2)) + 1];
    for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  }

  int count() const { return count_; }  ///< number of contact points, near or not

  /// The method takes the blocks that hold mass from now on. Points of the blocks around them are near too: the stencil
  /// of a point at the edge of its block reaches nodes of the next.
  void fit(const std::vector<int>& active_blocks) {
    for (auto& ranges : groups_.ranges) ranges.clear();
    std::vector<int> near;
    for (const int block : with_neighbours(active_blocks)) {
      const int begin = first_[static_cast<std::size_t>(block)], end = first_[static_cast<std::size_t>(block) + 1];
      if (begin == end) continue;
      if (by_list()) {
        for (int c = begin; c < end; ++c) near.push_back(c);
      } else {
        groups_.ranges[(block % blocks_x_ & 1) + 2 * (block / blocks_x_ & 1)].emplace_back(begin, end);
      }
    }
    list_.upload(near);
    groups_.upload(device_);
  }

  /// The method runs kernel(c) for every contact point beside the mass, such that scatter_add never meets itself.
  template <class Kernel>
  void each(const Kernel& kernel) const {
    if (by_list()) {
      for_each(device_, static_cast<int>(list_.size()), OverList<Kernel>{kernel, list_.data()});
    } else {
      for_each_grouped(device_, count_, groups_, kernel);
    }
  }

  std::size_t bytes() const { return list_.bytes(); }

 private:
  /// The blocks and those that touch one of them, in order.
  std::vector<int> with_neighbours(const std::vector<int>& blocks) const {
    const int count = static_cast<int>(first_.size()) - 1;
    std::vector<char> taken(static_cast<std::size_t>(count), 0);
    for (const int block : blocks) {
      const int x = block % blocks_x_, y = block / blocks_x_;
      for (int j = std::max(y - 1, 0); j <= y + 1 && j * blocks_x_ < count; ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, blocks_x_ - 1); ++i)
          taken[static_cast<std::size_t>(j * blocks_x_ + i)] = 1;
    }
    std::vector<int> all;
    for (int block = 0; block < count; ++block)
      if (taken[static_cast<std::size_t>(block)] != 0) all.push_back(block);
    return all;
  }
  bool by_list() const { return Device::is_gpu && !groups_.in_order; }

  Device device_;
  int count_, blocks_x_;
  std::vector<int> first_;    ///< contact point of every block, and the count behind the last
  Buffer<int, Device> list_;  ///< the contact points of the blocks in use, where a GPU goes over them
  PointGroups groups_;        ///< the same as ranges, for all others
};

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
        if (grid.slots[j * across + i].layers > 0) return;
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

  bool on() const { return count() > 0; }        ///< whether there are contact points
  int count() const { return nearby_.count(); }  ///< number of contact points

  ContactView<Real> view() { return arrays_.view(); }  ///< contact points as kernels see them

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

  ContactState state() const { return arrays_.state(); }  ///< forces and impulses that a checkpoint keeps

  std::size_t bytes() const { return arrays_.bytes() + nearby_.bytes(); }

 private:
  Device device_;
  std::vector<int> bodies_;
  std::size_t obstacles_;
  ContactArrays<Real, Device> arrays_;
  NearbyContacts<Device> nearby_;
};

}  // namespace talus::solver
