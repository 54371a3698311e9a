// The material points: arrays of their state, owned (Particles) and as a kernel sees them (ParticleView).
#pragma once

#include <cstdint>
#include <vector>

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/math.hpp"
#include "solver/state/grid_view.hpp"

namespace talus {

/// Positions are the nearest node and the offset from it in cells, so that single precision keeps 1e-8 of a cell
/// anywhere. A point whose cell_x is negative has left the domain.
template <class Real>
struct ParticleView {
  int count = 0;
  int *cell_x, *cell_y, *cell_z;         // nearest node
  Real *offset_x, *offset_y, *offset_z;  // from it, in cells [-0.5, 0.5)
  Real* velocity[3];                     // [m/s]
  Real* affine[9];                       // velocity change per cell, columns x, y, zeta [m/s]; null without APIC
  Real* elastic[6];                      // what the material keeps: xx yy zz xy yz xz (see material.hpp)
  Real* log_volume;                      // ln(volume / initial volume) [-]
  Real* plastic_log_volume;              // the part of it that is plastic dilation; null when there is none
  Real* volume;                          // initial [m3]; mass is volume times the density of the scene
  Real* extent[3];  // sides of the box it stands for, along x, y, zeta, in cells; null unless functions are averaged
                    // over it
  Real* move[3];    // displacement of this step in cells; null unless MUSL
  Real* acceleration[3];  // [m/s2]; null unless Newmark
  int* id;                // order of seeding
  int* release;           // which release it belongs to
  int* load;              // which load pulls at it, -1: none; null without loads
  int* material;          // which it is of; null in a scene of one
  Real* plastic_shear;    // equivalent plastic shear strain so far [-]; null unless a material softens

  static constexpr double place_bytes = 3 * (sizeof(int) + sizeof(Real));  // of a position

  TALUS_HD Vec3<Real> velocity_of(int p) const { return {velocity[0][p], velocity[1][p], velocity[2][p]}; }
  TALUS_HD Sym3<Real> elastic_of(int p) const {
    return {elastic[0][p], elastic[1][p], elastic[2][p], elastic[3][p], elastic[4][p], elastic[5][p]};
  }
  TALUS_HD void set_elastic(int p, const Sym3<Real>& s) const {
    elastic[0][p] = s.xx;
    elastic[1][p] = s.yy;
    elastic[2][p] = s.zz;
    elastic[3][p] = s.xy;
    elastic[4][p] = s.yz;
    elastic[5][p] = s.xz;
  }

  TALUS_HD Mat3<Real> affine_of(int p) const {
    return {{affine[0][p], affine[1][p], affine[2][p]},
            {affine[3][p], affine[4][p], affine[5][p]},
            {affine[6][p], affine[7][p], affine[8][p]}};
  }
  template <class Number>
  TALUS_HD void set_affine(int p, const Mat3<Number>& m) const {
    const Number values[9] = {m.a.x, m.a.y, m.a.z, m.b.x, m.b.y, m.b.z, m.c.x, m.c.y, m.c.z};
    for (int q = 0; q < 9; ++q) affine[q][p] = static_cast<Real>(values[q]);
  }

  /// Half the sides of a point's box as weights use them, in cells.
  TALUS_HD Real half_extent(int p, int axis, Real least) const {
    const Real half = Real(0.5) * extent[axis][p];
    return half < Real(0.5) ? (half > least ? half : least) : Real(0.5);
  }
  /// The box after a step with displacement gradient g over ground of these slopes: its sides grow with what happens
  /// along them.
  TALUS_HD void stretch_box(int p, const Mat3<Real>& g, Real slope_x, Real slope_y) const {
    const Real rise = slope_x * g.c.x + slope_y * g.c.y;
    extent[0][p] *= Real(1) + g.a.x + slope_x * g.c.x;
    extent[1][p] *= Real(1) + g.b.y + slope_y * g.c.y;
    extent[2][p] *= Real(1) + g.c.z - rise;
  }

  /// New cell and offset after a move in cells: nothing goes below the ground or behind a wall.
  template <class Move>
  TALUS_HD void move_by(int p, const Vec3<Move>& way, const WallNodes& walls) const {
    shift(cell_x[p], offset_x[p], way.x, walls.west, walls.east);
    shift(cell_y[p], offset_y[p], way.y, walls.south, walls.north);
    shift(cell_z[p], offset_z[p], way.z, 0, WallNodes::far);
  }

 private:
  template <class Move>
  TALUS_HD static void shift(int& cell, Real& offset, Move move, int first, int last) {
    const Move to = static_cast<Move>(offset) + move;
    const Move whole = floor(to + Move(0.5));
    offset = static_cast<Real>(to);
    if (!(fabs(whole) < Move(1000000))) return;  // lost: the step's settle() reports the point
    offset = static_cast<Real>(to - whole);
    cell += static_cast<int>(whole);
    if (cell < first || (cell == first && offset < Real(0))) {
      cell = first;
      offset = Real(0);
    } else if (cell > last || (cell == last && offset > Real(0))) {
      cell = last;
      offset = Real(0);
    }
  }
};

/// Host copy of the whole state, in double.
struct ParticleState {
  std::vector<int> cell[3], id, release, load, material;
  std::vector<double> offset[3], extent[3], velocity[3], acceleration[3], affine[9], elastic[6], log_volume,
      plastic_log_volume, plastic_shear, volume;
  std::size_t size() const { return id.size(); }
};

/// Which optional arrays a scene needs.
struct ParticleFields {
  bool affine = false, plastic_volume = false, extent = false, move = false, acceleration = false, load = false,
       material = false, plastic_shear = false;
};

template <class Real, class Device>
class Particles {
 public:
  Particles(const Device& device, ParticleFields fields) : device_(device), fields_(fields) {}
  explicit Particles(ParticleFields fields) : Particles(Device{}, fields) {}

  void upload(const ParticleState& state);
  ParticleState download() const;
  /// Without what only a further step needs: affine velocity, acceleration, boxes, loads.
  ParticleState download_shown() const;
  ParticleView<Real> view();
  int count() const { return count_; }
  std::size_t bytes() const;
  const Buffer<Real, Device>& volume() const { return reals_[volume_slot]; }

  /// New order: point order[p] becomes point p; only the first `count` are kept.
  void reorder(const Buffer<int, Device>& order, int count);

 private:
  static constexpr int offset_slot = 0, velocity_slot = 3, elastic_slot = 6, log_slot = 12, volume_slot = 13,
                       plastic_slot = 14, affine_slot = 15, acceleration_slot = 24, extent_slot = 27, shear_slot = 30,
                       move_slot = 31, real_slots = 34;
  static constexpr int load_slot = 5, material_slot = 6, int_slots = 7;
  bool in_use(int slot) const;
  bool int_in_use(int slot) const;
  void reorder_together(const Buffer<int, Device>& order, int count);
  Device device_;
  ParticleFields fields_;
  int count_ = 0;
  Buffers<Real, Device, real_slots> reals_{device_};
  Buffers<int, Device, int_slots> ints_{device_};         // cell x y z, id, release, load, material
  Buffers<Real, Device, move_slot> real_twins_{device_};  // of as many points as may be kept twice
  Buffers<int, Device, int_slots> int_twins_{device_};
  Buffer<Real, Device> real_scratch_{device_};
  Buffer<int, Device> int_scratch_{device_};
};

}  // namespace talus
