// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of the material points: one table, from which come their storage, the view that kernels have of it, the
// copy on the host, sorting, checkpoints and frames (docs/notes/code-structure.md). A new state variable is a
// line here and the kernel that uses it.
#pragma once

#include <cstddef>
#include <string>
#include <type_traits>

namespace talus {

/// The needs of a run of its points, beyond what every run needs.
struct ParticleNeeds {
  bool affine_transfer = false;    ///< APIC
  bool plastic_volume = false;     ///< some material dilates
  bool boxes = false;              ///< functions are averaged over the box of each point (GIMP)
  bool remapped_velocity = false;  ///< explicit steps by MUSL
  bool accelerations = false;      ///< implicit steps
  bool loads = false;
  bool several_materials = false;
  bool softening = false;  ///< some material softens
  bool always = true;      ///< last, so that no list of values switches it off by position
};

/// How long a field is kept, and where it is written; each includes the one before.
enum class Kept {
  within_step,    ///< means nothing between steps: neither sorted nor written
  in_checkpoint,  ///< kept across steps, sorted with the points, and written to checkpoints
  in_frames       ///< copied to the host for frames too
};

// A line: name, numbers (Ints or Reals), components, unit, what needs it (a member of ParticleNeeds), how long it is
// kept, and its value where a state does not have it. Positions are the nearest node and the offset from it in cells,
// so that single precision keeps 1e-8 of a cell anywhere. A point whose cell[0] is negative has left the domain.
// clang-format off
#define TALUS_PARTICLE_FIELDS(FIELD)                                                               \
  /* nearest node: column, row, layer */                                                           \
  FIELD(cell,               Ints,  3, "1",     always,            in_frames,     0)                \
  /* from the nearest node, along x, y, zeta, in [-0.5, 0.5) */                                    \
  FIELD(offset,             Reals, 3, "cells", always,            in_frames,     0)                \
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
  FIELD(volume,             Reals, 1, "m3",    always,            in_frames,     0)                \
  /* sides of the box that a point stands for, along x, y, zeta */                                 \
  FIELD(extent,             Reals, 3, "cells", boxes,             in_checkpoint, 0)                \
  /* displacement of this step */                                                                  \
  FIELD(move,               Reals, 3, "cells", remapped_velocity, within_step,   0)                \
  FIELD(acceleration,       Reals, 3, "m/s2",  accelerations,     in_checkpoint, 0)                \
  /* order of seeding */                                                                           \
  FIELD(id,                 Ints,  1, "1",     always,            in_frames,     0)                \
  /* which release a point belongs to */                                                           \
  FIELD(release,            Ints,  1, "1",     always,            in_frames,     0)                \
  /* which load pulls at a point, -1: none */                                                      \
  FIELD(load,               Ints,  1, "1",     loads,             in_checkpoint, -1)               \
  /* which material a point is of */                                                               \
  FIELD(material,           Ints,  1, "1",     several_materials, in_frames,     0)                \
  /* equivalent plastic shear strain so far */                                                     \
  FIELD(plastic_shear,      Reals, 1, "1",     softening,         in_frames,     0)
// clang-format on

/// A member of ParticleNeeds. (Under a name, since nvcc writes a bare one in a way that GCC warns of.)
using ParticleNeed = bool ParticleNeeds::*;

/// A line of the table.
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

}  // namespace talus
