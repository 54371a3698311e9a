// Contact points where the kernels run (see contact_points.hpp): their arrays, what they gave so far, and how kernels
// go over those beside the mass.
#pragma once

#include <algorithm>

#include "solver/boundary/base_friction.hpp"
#include "solver/boundary/contact_points.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/state/contact_state.hpp"
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
  BaseFriction<Real> ground;
  Real* inverse_mass;   ///< of the mass before it in this step [1/kg]; 0: there is none
  Vec3<double>* force;  ///< see ContactState
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
  /// the side it looks to, not what a wall thinner than a cell keeps on its other side, whose nodes are the same. The
  /// ground has but one side.
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
    return body[c] == ContactPoints::ground || rise * grid.spacing > Real(-0.5) * mass ? mass : Real(0);
  }

  /// The resistance to a slip at a contact point.
  struct Grip {
    Real coefficient = 0;  ///< of the normal force
    Real traction = 0;     ///< besides [Pa]
  };
  /// The resistance at contact point c: the obstacle's friction, or that of the bed there.
  TALUS_HD Grip grip(const GridView<Real>& grid, int c, const Slip<Real>& slip) const {
    if (body[c] != ContactPoints::ground) return {body_friction[body[c]], Real(0)};
    if (ground.holds()) return {Real(1e6), Real(0)};
    const Bed<Real>& bed = ground.at(grid.column(places.cell[0][c], places.cell[1][c]));
    return {ground.coefficient(bed, slip), ground.traction(bed, slip)};
  }

  /// The share to which the bed at point c is covered: a layer's worth of mass makes it a full one, of which half lies
  /// within the weights of a point on a surface.
  TALUS_HD Real filled(const GridView<Real>& grid, int c, double layer_mass) const {
    const Real share = Real(1) / (inverse_mass[c] * Real(0.5 * layer_mass) * grid.spacing * grid.spacing);
    return share < Real(1) ? share : Real(1);
  }

  /// The force or impulse that the surface can give towards the one `wanted`, H of (T12a): it pushes, and holds back
  /// slip up to `coefficient` times the push and `more`.
  TALUS_HD static Vec3<Real> hold(const Vec3<Real>& wanted, const Vec3<Real>& normal, Real coefficient, Real more) {
    const Real push = dot(wanted, normal);
    if (!(push > Real(0))) return {};
    const Vec3<Real> along = wanted - normal * push;
    const Real size = length(along), limit = coefficient * push + more;
    return size > limit ? normal * push + along * (limit / size) : wanted;
  }
};

/// One thread: one contact point of the list.
template <class Kernel>
struct OverList {
  using Named = Kernel;
  Kernel kernel;
  const int* list;
  TALUS_HD void operator()(int t) const { kernel(list[t]); }
};

/// One thread: one contact point. It forgets its force where the mass has left the block.
template <class Real>
struct ForgetForces {
  GridView<Real> grid;
  ContactView<Real> contacts;
  TALUS_HD void operator()(int c) const {
    if (grid.slot(contacts.places.cell[0][c], contacts.places.cell[1][c]).offset >= 0) return;
    contacts.force[c] = {};
    contacts.inverse_mass[c] = Real(0);
  }
};

/// The contact points on a device with their history.
template <class Real, class Device, class Shape>
class SurfaceContact {
 public:
  SurfaceContact(const Device& device, const ContactPoints& points, const BaseFriction<Real>& ground,
                 const GridShape& shape, const ContactState& state, bool in_order)
      : device_(device),
        count_(static_cast<int>(points.size())),
        blocks_x_((shape.columns + block_side - 1) / block_side) {
    groups_.in_order = in_order;
    if (count_ == 0) return;
    view_.ground = ground;
    for (std::size_t a = 0; a < 3; ++a) {
      cell_[a].upload(points.cell[a]);
      upload_as(offset_[a], points.offset[a]);
      none_.upload(std::vector<Real>(points.size()));
    }
    std::vector<Vec3<Real>> normals;
    for (const Vec3<double>& n : points.normal)
      normals.push_back({static_cast<Real>(n.x), static_cast<Real>(n.y), static_cast<Real>(n.z)});
    normal_.upload(normals);
    upload_as(area_, points.area);
    inverse_mass_.upload(std::vector<Real>(points.size()));
    body_.upload(points.body);
    upload_as(friction_, points.friction);
    bodies_ = points.body;
    obstacles_ = points.friction.size();
    upload_vectors(force_, state.force);
    upload_vectors(impulse_, state.impulse);
    list_blocks(points, (shape.rows + block_side - 1) / block_side);
  }

  /// Whether there are contact points.
  bool on() const { return count_ > 0; }
  /// The number of contact points.
  int count() const { return count_; }

  /// The contact points as kernels see them.
  ContactView<Real> view() {
    ContactView<Real> v = view_;
    v.places = {};
    v.places.cell[0] = cell_[0].data();
    v.places.cell[1] = cell_[1].data();
    v.places.cell[2] = cell_[2].data();
    v.places.offset[0] = offset_[0].data();
    v.places.offset[1] = offset_[1].data();
    v.places.offset[2] = offset_[2].data();
    for (auto& extent : v.places.extent) extent = none_.data();
    v.normal = normal_.data();
    v.area = area_.data();
    v.body = body_.data();
    v.body_friction = friction_.data();
    v.inverse_mass = inverse_mass_.data();
    v.force = force_.data();
    v.impulse = impulse_.data();
    return v;
  }

  /// The method lists the contact points beside the mass, once the grid has been fitted to it.
  template <class Grid>
  void fit(const Grid& grid) {
    if (!on()) return;
    for (auto& ranges : groups_.ranges) ranges.clear();
    std::vector<int> beside, active(static_cast<std::size_t>(grid.active_blocks()));
    copy_to_host(device_, active.data(), grid.active_list(), active.size() * sizeof(int));
    for (const int block : active) {
      const int begin = first_[static_cast<std::size_t>(block)], end = first_[static_cast<std::size_t>(block) + 1];
      if (begin == end) continue;
      if (by_list()) {
        for (int c = begin; c < end; ++c) beside.push_back(c);
      } else {
        groups_.ranges[(block % blocks_x_ & 1) + 2 * (block / blocks_x_ & 1)].emplace_back(begin, end);
      }
    }
    beside_.upload(beside);
    groups_.upload(device_);
    for_each(device_, count_, ForgetForces<Real>{grid.view(), view()});
  }

  /// The method runs kernel(c) for every contact point of the blocks in use, such that scatter_add never meets itself.
  template <class Kernel>
  void each(const Kernel& kernel) {
    if (by_list()) {
      for_each(device_, static_cast<int>(beside_.size()), OverList<Kernel>{kernel, beside_.data()});
    } else {
      for_each_grouped(device_, count_, groups_, kernel);
    }
  }

  /// The impulse that every obstacle was given so far, [obstacles] [N s].
  std::vector<Vec3<double>> obstacle_impulses() const {
    std::vector<Vec3<double>> sums(obstacles_);
    const std::vector<Vec3<double>> impulses = impulse_.download();
    for (std::size_t c = 0; c < impulses.size(); ++c) {
      if (bodies_[c] != ContactPoints::ground) sums[static_cast<std::size_t>(bodies_[c])] += impulses[c] * -1.0;
    }
    return sums;
  }

  /// The forces and impulses that a checkpoint keeps.
  ContactState state() const { return {download_vectors(force_), download_vectors(impulse_)}; }

  /// The size of the arrays [bytes].
  std::size_t bytes() const {
    std::size_t total = none_.bytes() + normal_.bytes() + area_.bytes() + body_.bytes() + friction_.bytes() +
                        force_.bytes() + impulse_.bytes() + beside_.bytes() + inverse_mass_.bytes();
    for (std::size_t a = 0; a < 3; ++a) total += cell_[a].bytes() + offset_[a].bytes();
    return total;
  }

 private:
  bool by_list() const { return Device::is_gpu && !groups_.in_order; }
  void upload_vectors(Buffer<Vec3<double>, Device>& to, const std::vector<double>& from) {
    std::vector<Vec3<double>> vectors(static_cast<std::size_t>(count_));
    for (std::size_t c = 0; 3 * c + 2 < from.size() && c < vectors.size(); ++c)
      vectors[c] = {from[3 * c], from[3 * c + 1], from[3 * c + 2]};
    to.upload(vectors);
  }
  static std::vector<double> download_vectors(const Buffer<Vec3<double>, Device>& from) {
    std::vector<double> numbers;
    for (const Vec3<double>& v : from.download()) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return numbers;
  }
  void list_blocks(const ContactPoints& points, int blocks_y) {
    first_.assign(static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_y) + 1, 0);
    for (std::size_t c = 0; c < points.size(); ++c)
      ++first_[static_cast<std::size_t>((points.cell[1][c] >> 2) * blocks_x_ + (points.cell[0][c] >> 2)) + 1];
    for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
  }

  Device device_;
  int count_ = 0, blocks_x_ = 0;
  std::vector<int> bodies_;
  std::vector<int> first_;  ///< contact point of every block, and the count behind the last
  std::size_t obstacles_ = 0;
  ContactView<Real> view_{};
  Buffers<int, Device, 3> cell_{device_};
  Buffers<Real, Device, 3> offset_{device_};
  Buffer<int, Device> body_{device_};
  Buffer<int, Device> beside_{device_};  ///< the contact points of the blocks in use; on the CPU groups_ has them
  Buffer<Real, Device> none_{device_}, area_{device_}, friction_{device_}, inverse_mass_{device_};
  Buffer<Vec3<Real>, Device> normal_{device_};
  Buffer<Vec3<double>, Device> force_{device_}, impulse_{device_};
  PointGroups groups_;
};

}  // namespace talus::solver
