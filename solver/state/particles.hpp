// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The material points: arrays of their state, owned (Particles) and as a kernel sees them (ParticleView).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/parallel/for_each.hpp"
#include "solver/state/grid_view.hpp"

namespace talus {

/// The needs of a run of its points, beyond what every run needs.
struct ParticleNeeds {
  bool affine_transfer = false;    ///< APIC
  bool plastic_volume = false;     ///< some material dilates
  bool boxes = false;              ///< functions are averaged over the box of each point (GIMP)
  bool remapped_velocity = false;  ///< explicit steps by MUSL
  bool accelerations = false;      ///< implicit steps
  bool loads = false;
  bool spreads = false;  ///< mass may be drawn out so far that its points are split
  bool several_materials = false;
  bool softening = false;  ///< the plastic shear strain counts: some material softens, or water takes notice of it
  bool water = false;      ///< water flows between the grains
  bool always = true;      ///< last, so that no list of values switches it off by position
};

/// How long a field is kept, and where it is written; each includes the one before.
enum class Kept {
  within_step,    ///< means nothing between steps: neither sorted nor written
  in_checkpoint,  ///< kept across steps, sorted with the points, and written to checkpoints
  in_frames,      ///< copied to the host for frames too
  to_the_end      ///< and for what is made of a run's last state
};

// A line: name, numbers (Ints or Reals), components, unit, what needs it (a member of ParticleNeeds), how long it is
// kept, and its value where a state does not have it. Positions are the nearest node and the offset from it in cells,
// so that single precision keeps 1e-8 of a cell anywhere. A point whose cell[0] is negative has left the domain.
// clang-format off
#define TALUS_PARTICLE_FIELDS(FIELD)                                                               \
  /* nearest node: column, row, layer */                                                           \
  FIELD(cell,               Ints,  3, "1",     always,            to_the_end,    0)                \
  /* from the nearest node, along x, y, zeta, in [-0.5, 0.5) */                                    \
  FIELD(offset,             Reals, 3, "cells", always,            to_the_end,    0)                \
  FIELD(velocity,           Reals, 3, "m/s",   always,            in_frames,     0)                \
  /* velocity change per cell, columns x, y, zeta */                                               \
  FIELD(affine,             Reals, 9, "m/s",   affine_transfer,   in_checkpoint, 0)                \
  /* what the material keeps: xx yy zz xy yz xz (material.hpp) */                                  \
  FIELD(elastic,            Reals, 6, "1",     always,            in_frames,     0)                \
  /* ln(volume / initial volume) */                                                                \
  FIELD(log_volume,         Reals, 1, "1",     always,            in_frames,     0)                \
  /* the part of log_volume that is plastic dilation */                                            \
  FIELD(plastic_log_volume, Reals, 1, "1",     plastic_volume,    in_frames,     0)                \
  /* initial volume; mass is volume times the density of the scene */                              \
  FIELD(volume,             Reals, 1, "m3",    always,            to_the_end,    0)                \
  /* sides of the box that a point stands for, along x, y, zeta */                                 \
  FIELD(extent,             Reals, 3, "cells", boxes,             in_checkpoint, 0)                \
  /* two sides of what a point stands for, along the ground at first: x, y, z of each */           \
  FIELD(sides,              Reals, 6, "m",     spreads,           in_checkpoint, 0)                \
  /* which part of the seeded point: 1, or of the halves of piece n the 2n-th and the next */       \
  FIELD(piece,              Ints,  1, "1",     spreads,           in_frames,     1)                \
  /* displacement of this step */                                                                  \
  FIELD(move,               Reals, 3, "cells", remapped_velocity, within_step,   0)                \
  FIELD(acceleration,       Reals, 3, "m/s2",  accelerations,     in_checkpoint, 0)                \
  /* order of seeding */                                                                           \
  FIELD(id,                 Ints,  1, "1",     always,            to_the_end,    0)                \
  /* which release a point belongs to */                                                           \
  FIELD(release,            Ints,  1, "1",     always,            to_the_end,    0)                \
  /* which load pulls at a point, -1: none */                                                      \
  FIELD(load,               Ints,  1, "1",     loads,             in_checkpoint, -1)               \
  /* which material a point is of */                                                               \
  FIELD(material,           Ints,  1, "1",     several_materials, in_frames,     0)                \
  /* equivalent plastic shear strain so far */                                                     \
  FIELD(plastic_shear,      Reals, 1, "1",     softening,         in_frames,     0)                \
  /* across the bed, borne by the grains; negative: pore_water.hpp */                              \
  FIELD(effective_stress,   Reals, 1, "Pa",    water,             in_frames,     -2)               \
  /* the share of friction that water leaves, or below 0 all of it beside a suction [Pa] */        \
  FIELD(water_strength,     Reals, 1, "1",     water,             in_checkpoint, 1)                \
  /* rate at which water adds to ln(volume) */                                                     \
  FIELD(water_inflow,       Reals, 1, "1/s",   water,             in_checkpoint, 0)                \
  /* what of ln(volume) water was to add at the last step with it */                               \
  FIELD(water_due,          Reals, 1, "1",     water,             in_checkpoint, 0)                \
  /* plastic_shear at the last step with water */                                                  \
  FIELD(shear_seen,         Reals, 1, "1",     water,             in_checkpoint, 0)
// clang-format on

/// How often a point may be halved.
inline constexpr int most_halvings = 2;
/// The smallest parts of a point.
inline constexpr int smallest_parts = 1 << most_halvings;

/// The smallest parts of a seeded point that a piece of it holds, of 0 to smallest_parts - 1.
struct PartRange {
  int first, count;
  TALUS_HD explicit PartRange(int piece) : first(piece), count(1) {
    while (first < smallest_parts) {
      first *= 2;
      count *= 2;
    }
    first -= smallest_parts;
  }
};

/// A member of ParticleNeeds. (Under a name, since nvcc writes a bare one in a way that GCC warns of.)
using ParticleNeed = bool ParticleNeeds::*;

struct ParticleField {
  const char* name;
  bool whole;  ///< whole numbers
  int components;
  const char* unit;
  ParticleNeed needed_by;
  Kept kept;
  int initial;

  /// The name of one of its components, as files have it: "velocity_0", but "volume" where there is one.
  std::string name_of(int component) const {
    return components == 1 ? name : std::string(name) + '_' + std::to_string(component);
  }
};

/// Whether the host may go without a list of a field: what not every run needs is mostly the initial value everywhere.
constexpr bool may_be_empty(const ParticleField& field) { return field.needed_by != &ParticleNeeds::always; }

/// The table.
inline constexpr ParticleField particle_fields[] = {
#define TALUS_LINE(name, numbers, components, unit, needed_by, kept, initial) \
  {#name, #numbers[0] == 'I', components, unit, &ParticleNeeds::needed_by, Kept::kept, initial},
    TALUS_PARTICLE_FIELDS(TALUS_LINE)
#undef TALUS_LINE
};

/// The number of components of all fields of whole (or of real) numbers that are kept across steps.
constexpr int components_kept(bool whole) {
  int count = 0;
  for (const ParticleField& field : particle_fields) {
    if (field.whole == whole && field.kept != Kept::within_step) count += field.components;
  }
  return count;
}

/// One T for a field of one component, else an array of them.
template <class T, std::size_t components>
using FieldOf = std::conditional_t<components == 1, T, T[components]>;

/// Declares a member for every field, in a class that has types Ints and Reals.
#define TALUS_DECLARE_FIELD(name, numbers, components, ...) FieldOf<numbers, components> name{};
#define TALUS_DECLARE_PARTICLE_FIELDS TALUS_PARTICLE_FIELDS(TALUS_DECLARE_FIELD)

/// The only component of a field of one, whatever the number.
template <class T>
T& component_of(T& only, int) {
  return only;
}
template <class T, std::size_t components>
T& component_of(T (&all)[components], int component) {
  return all[component];
}

/// This function calls item(field, component, members...) for every component of every field, with what each of the
/// holders (classes with TALUS_DECLARE_PARTICLE_FIELDS) has for it.
template <class Item, class... Holders>
void visit_particle_fields(Item&& item, Holders&... holders) {
  const ParticleField* field = particle_fields;
#define TALUS_VISIT(name, ...)                                          \
  for (int component = 0; component < field->components; ++component) { \
    item(*field, component, component_of(holders.name, component)...);  \
  }                                                                     \
  ++field;
  TALUS_PARTICLE_FIELDS(TALUS_VISIT)
#undef TALUS_VISIT
}

/// The fields of the points as a kernel sees them: a pointer for each component, null where the run does not
/// need the field.
template <class Real>
struct ParticleView {
  using Ints = int*;
  using Reals = Real*;
  int count = 0;
  TALUS_DECLARE_PARTICLE_FIELDS

  static constexpr double place_bytes = 3 * (sizeof(int) + sizeof(Real));  ///< of a position

  /// The velocity of point p [m/s].
  TALUS_HD Vec3<Real> velocity_of(int p) const { return {velocity[0][p], velocity[1][p], velocity[2][p]}; }
  TALUS_HD void set_velocity(int p, const Vec3<Real>& v) const {
    velocity[0][p] = v.x;
    velocity[1][p] = v.y;
    velocity[2][p] = v.z;
  }
  /// The elastic state of point p, as its material keeps it [-].
  TALUS_HD Sym3<Real> elastic_of(int p) const {
    return {elastic[0][p], elastic[1][p], elastic[2][p], elastic[3][p], elastic[4][p], elastic[5][p]};
  }
  /// The method stores the elastic state of point p.
  TALUS_HD void set_elastic(int p, const Sym3<Real>& s) const {
    elastic[0][p] = s.xx;
    elastic[1][p] = s.yy;
    elastic[2][p] = s.zz;
    elastic[3][p] = s.xy;
    elastic[4][p] = s.yz;
    elastic[5][p] = s.xz;
  }

  /// The affine velocity of point p per cell, C_p of (T8) in columns x, y, zeta [m/s].
  TALUS_HD Mat3<Real> affine_of(int p) const {
    return {{affine[0][p], affine[1][p], affine[2][p]},
            {affine[3][p], affine[4][p], affine[5][p]},
            {affine[6][p], affine[7][p], affine[8][p]}};
  }
  /// The method stores the affine velocity of point p.
  template <class Number>
  TALUS_HD void set_affine(int p, const Mat3<Number>& m) const {
    const Number values[9] = {m.a.x, m.a.y, m.a.z, m.b.x, m.b.y, m.b.z, m.c.x, m.c.y, m.c.z};
    for (int q = 0; q < 9; ++q) affine[q][p] = static_cast<Real>(values[q]);
  }

  /// Half the side of a point's box along an axis as weights use it [cells]: at least `least`, at most half a cell.
  TALUS_HD Real half_extent(int p, int axis, Real least) const {
    const Real half = Real(0.5) * extent[axis][p];
    return half < Real(0.5) ? (half > least ? half : least) : Real(0.5);
  }
  /// Stretches the box (T2a) by g = dt grad v over ground of these slopes, each side by what happens along it.
  TALUS_HD void stretch_box(int p, const Mat3<Real>& g, Real slope_x, Real slope_y) const {
    const Real rise = slope_x * g.c.x + slope_y * g.c.y;
    extent[0][p] *= Real(1) + g.a.x + slope_x * g.c.x;
    extent[1][p] *= Real(1) + g.b.y + slope_y * g.c.y;
    extent[2][p] *= Real(1) + g.c.z - rise;
  }

  /// Side 0 or 1 of what point p stands for [m].
  TALUS_HD Vec3<Real> side_of(int p, int side) const {
    return {sides[3 * side][p], sides[3 * side + 1][p], sides[3 * side + 2][p]};
  }
  TALUS_HD void set_side(int p, int side, const Vec3<Real>& e) const {
    sides[3 * side][p] = e.x;
    sides[3 * side + 1][p] = e.y;
    sides[3 * side + 2][p] = e.z;
  }
  /// Turns and stretches the sides of point p with the mass, by g = dt grad v.
  TALUS_HD void stretch_sides(int p, const Mat3<Real>& g) const {
    for (int side = 0; side < 2; ++side) {
      const Vec3<Real> e = side_of(p, side);
      set_side(p, side, e + g.a * e.x + g.b * e.y + g.c * e.z);
    }
  }

  /// Moves point p by `way` [cells] to its new cell and offset: nothing goes below the ground or behind a wall.
  template <class Move>
  TALUS_HD void move_by(int p, const Vec3<Move>& way, const WallNodes& walls) const {
    shift(cell[0][p], offset[0][p], way.x, walls.west, walls.east);
    shift(cell[1][p], offset[1][p], way.y, walls.south, walls.north);
    shift(cell[2][p], offset[2][p], way.z, 0, WallNodes::far);
  }

 private:
  template <class Move>
  TALUS_HD static void shift(int& cell, Real& offset, Move move, int first, int last) {
    const Move to = static_cast<Move>(offset) + move;
    const Move whole = Move(floor(to + Move(0.5)));
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

/// A copy of the points on the host, in double; lists of one length, or empty where they were not asked for, or where
/// they may_be_empty() and all points have the initial value.
struct ParticleState {
  using Ints = std::vector<int>;
  using Reals = std::vector<double>;
  TALUS_DECLARE_PARTICLE_FIELDS

  std::size_t size() const { return id.size(); }  ///< number of points
  void resize(std::size_t count);                 ///< makes room for `count` points at their initial values
  /// The material of point p.
  std::size_t material_of(std::size_t p) const { return material.empty() ? 0 : static_cast<std::size_t>(material[p]); }
};

/// The owner of the points' arrays on a device.
template <class Real, class Device>
class Particles {
 public:
  Particles(const Device& device, ParticleNeeds needs);

  /// The method takes the lists of the fields that are needed; those kept within a step alone get memory.
  void upload(const ParticleState& state);
  void append(const ParticleState& more);  ///< adds points behind those that are there
  /// The fields that are kept at least so long, in double; lists of those that are not needed are empty.
  ParticleState download(Kept least = Kept::in_checkpoint) const {
    ParticleState state;
    download(least, state);
    return state;
  }
  /// The same into lists, whose memory they keep where that is enough; other fields stay as they are.
  void download(Kept least, ParticleState& to) const;
  ParticleView<Real> view();            ///< points as kernels see them, until the next upload() or reorder()
  int count() const { return count_; }  ///< number of points
  const ParticleNeeds& needs() const { return needs_; }  ///< what the run needs of its points
  std::size_t bytes() const;
  /// The initial volumes of the points [m3], on the device.
  const Buffer<Real, Device>& volume() const { return arrays_.volume; }

  /// Halves points that are drawn out beyond a cell of the grid (T10c); returns whether there were any. `keys`: those
  /// of the points' cells (home_key()), by which they are sorted; the halves are not.
  bool split(const GridView<Real>& grid, const std::uint64_t* keys);

  /// The method puts the points in a new order of `count`: point order[p] becomes point p, also where it is named twice
  /// or the order does not name all.
  void reorder(const Buffer<int, Device>& order, int count);

 private:
  struct Arrays {
    using Ints = Buffer<int, Device>;
    using Reals = Buffer<Real, Device>;
    TALUS_DECLARE_PARTICLE_FIELDS
  };

  bool holds(const ParticleField& field) const { return needs_.*field.needed_by; }
  bool sorts(const ParticleField& field) const { return holds(field) && field.kept != Kept::within_step; }
  void reorder_together(const Buffer<int, Device>& order, int count);
  Device device_;
  ParticleNeeds needs_;
  int count_ = 0;
  Arrays arrays_, twins_;  ///< the second set of as many points as may be kept twice
  Buffer<Real, Device> real_scratch_;
  Buffer<int, Device> int_scratch_;
};

}  // namespace talus
