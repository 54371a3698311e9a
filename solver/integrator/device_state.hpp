// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Bed, loads, shaking, maps and clock in the memory of a device, all that the mass can touch there, and what opens the
// steps of a batch.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/run/map_fields.hpp"
#include "solver/boundary/contact_impulses.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/settings.hpp"
#include "solver/parallel/host_room.hpp"
#include "solver/state/map_view.hpp"

namespace talus::solver {

/// The bed's friction and, where it changes from place to place, its numbers beside the grid.
template <class Number, class Device>
class DeviceBed {
 public:
  /// The constructor takes the law with the numbers that hold everywhere, those of every column in their place where
  /// there are any, and what water leaves the grains of the normal stress (BaseFriction::borne), [rows * columns].
  DeviceBed(const Device& device, const BaseFriction<double>& friction, const std::vector<Bed<double>>& columns,
            const double* borne = nullptr)
      : friction_(friction.as<Number>()), columns_(device) {
    friction_.borne = borne;
    if (columns.empty()) return;
    std::vector<Bed<Number>> beds;
    beds.reserve(columns.size());
    for (const Bed<double>& bed : columns) beds.push_back(bed.as<Number>());
    columns_.upload(beds);
    friction_.columns = columns_.data();
  }
  BaseFriction<Number> view() const { return friction_; }  ///< friction as kernels see it
  std::size_t bytes() const { return columns_.bytes(); }

 private:
  BaseFriction<Number> friction_;
  Buffer<Bed<Number>, Device> columns_;
};

/// The loads of a scene and the forces per volume that kernels read.
template <class Device>
class DeviceLoads {
 public:
  /// The constructor takes the loads with the volume of the particles that each pulls at [m3]; a scene whose list of
  /// volumes is empty has no loads.
  DeviceLoads(const Device& device, std::vector<LoadOptions> loads, std::vector<double> volumes)
      : loads_(std::move(loads)), volumes_(std::move(volumes)), densities_(device) {}

  /// The method uploads the force per volume of every load at a time in a step that began at `begin` [N/m3], for
  /// kernels until the next call; null when there are no loads.
  const Vec3<double>* upload(double begin, double time) {
    if (volumes_.empty()) return nullptr;
    densities_.upload(load_densities(loads_, volumes_, begin, time));
    return densities_.data();
  }
  /// Whether a load grows from a time on: every step asks for its own.
  bool grow_at(double time) const {
    return !volumes_.empty() && std::ranges::any_of(loads_, [&](const LoadOptions& l) {
      return l.ramp > 0 && time >= l.from && time < l.from + l.ramp;
    });
  }
  /// Whether a load jumps at a time.
  bool jump_at(double time) const { return loads_jump(loads_, volumes_, time); }

 private:
  std::vector<LoadOptions> loads_;
  std::vector<double> volumes_;  ///< [m3]
  Buffer<Vec3<double>, Device> densities_;
};

template <class Device>
class DeviceShaking {
 public:
  DeviceShaking(const Device& device, Shaking shaking) : shaking_(std::move(shaking)), samples_(device) {
    samples_.upload(shaking_.samples);
  }
  ShakingView view() const { return {samples_.data(), static_cast<int>(samples_.size())}; }
  const Shaking& host() const { return shaking_; }  ///< shaking on the host
  std::size_t bytes() const { return samples_.bytes(); }

 private:
  Shaking shaking_;
  Buffer<ShakingSample, Device> samples_;
};

/// The maps that kernels keep while a run goes on, [rows * columns] each.
template <class Device>
class DeviceMaps {
 public:
  /// Copies the maps that the run starts from; `threshold`: thickness from which speed, pressure and arrival count [m].
  DeviceMaps(const Device& device, const RunningMaps<std::vector<double>>& start, double threshold)
      : maps_(make_running_maps<Buffer<double, Device>>(device)), threshold_(threshold) {
    for_each_running_map([](const RunningMap&, auto& buffer, const auto& values) { buffer.upload(values); }, maps_,
                         start);
  }

  /// The maps as kernels see them.
  MapView view() {
    MapView view;
    for_each_running_map([](const RunningMap&, double*& values, auto& buffer) { values = buffer.data(); }, view, maps_);
    view.threshold = threshold_;
    return view;
  }

  /// The maps so far; waits for the device.
  RunningMaps<std::vector<double>> download() const {
    RunningMaps<std::vector<double>> all;
    for_each_running_map([](const RunningMap&, auto& values, const auto& buffer) { values = buffer.download(); }, all,
                         maps_);
    return all;
  }

  std::vector<double> grains_share() const { return maps_.grains_share.download(); }

  std::size_t bytes() const {
    std::size_t total = 0;
    for_each_running_map([&](const RunningMap&, const auto& buffer) { total += buffer.bytes(); }, maps_);
    return total;
  }

 private:
  RunningMaps<Buffer<double, Device>> maps_;
  double threshold_;
};

/// The surroundings of the mass on a device: they do not move with it, and remember what they gave to it.
template <class Real, class Device, class Shape>
class Surroundings {
 public:
  using Contact = SurfaceContact<Real, Device, Shape>;    ///< the surfaces between the nodes
  using Impulses = ContactImpulses<Real, Device, Shape>;  ///< what they give in velocities

  /// The constructor takes bed, walls and contact points of a scene, whose lowest ground is at `datum` [m], what the
  /// contact points gave before, and what grains bear at the bed (BaseFriction::borne).
  Surroundings(const Device& device, const Scene& scene, const IntegratorSettings& settings, const ContactState& state,
               double datum, const double* borne = nullptr)
      : bed_(device, settings.bed, scene.bed, borne),
        walls_(settings.walls),
        frame_{{scene.map.x(0), scene.map.y(0), datum},
               {scene.grid.spacing, scene.grid.spacing, scene.grid.layer_height}},
        contact_(device, scene.contacts, scene.grid, state, settings.deterministic),
        impulses_(device) {}

  BaseFriction<Real> bed() const { return bed_.view(); }  ///< bed's friction as kernels see it
  /// The walls that are there at a time [s], as kernels see them.
  template <class Number>
  Walls<Number> walls(double time) const {
    return walls_at<Number>(walls_, time, frame_);
  }
  Contact& contact() { return contact_; }  ///< surfaces between the nodes
  const Contact& contact() const { return contact_; }
  Impulses& impulses() { return impulses_; }  ///< sweeps in which those surfaces give impulses to the nodes

  std::size_t bed_bytes() const { return bed_.bytes(); }  ///< size of the bed's numbers [bytes]
  /// The size of what belongs to the contact points [bytes].
  std::size_t contact_bytes() const { return contact_.bytes() + impulses_.bytes(); }

 private:
  DeviceBed<Real, Device> bed_;
  std::vector<PlaneWall> walls_;
  WallFrame frame_;
  Contact contact_;
  Impulses impulses_;
};

/// A clock that host and kernels change in turns. Between steps the host asks for it several times; it is copied only
/// once kernels have had it, or the host has changed it.
template <class Device>
class DeviceClock {
 public:
  DeviceClock(const Device& device, const Clock& start) : host_(start), memory_(device), room_(device) {
    memory_.upload({host_});
  }

  /// The clock as it is; waits for the device where kernels have had it.
  Clock read() const {
    if (with_kernels_) host_ = lent_ ? lent() : memory_.download().front();
    with_kernels_ = lent_ = false;
    return host_;
  }
  void write(const Clock& clock) {
    host_ = clock;
    with_kernels_ = false;
    written_ = true;
  }
  /// The method hands the clock to the kernels that are started from here on, which may change it.
  void hand_over() {
    if (written_) memory_.upload({host_});
    written_ = false;
    with_kernels_ = true;
  }
  /// The method hands the clock over to kernels the first of which takes it from room() and the last of which leaves it
  /// there: no copy by the host is needed.
  void lend() {
    *room_ = host_;
    written_ = false;
    with_kernels_ = lent_ = true;
  }
  /// The clock for kernels, after hand_over() or lend(); always at the same address.
  Clock* data() { return memory_.data(); }
  Clock* room() { return &*room_; }  ///< where the host lends it, for kernels too

 private:
  Clock lent() const {
    synchronise(memory_.device());
    return *room_;
  }
  mutable Clock host_;
  mutable bool with_kernels_ = false;  ///< the copy on the host may be an old one
  mutable bool lent_ = false;          ///< and the room is to hold a new one
  bool written_ = false;               ///< the copy on the device is an old one
  Buffer<Clock, Device> memory_;
  HostRoom<Clock, Device> room_;
};

/// One thread. It opens a step of a batch, where one is left; the last one it closes: the clock halts where something
/// is due. The clock of a batch that has halted stays as it is. One that opens no step goes to the host.
struct OpenStep {
  const Clock* from;  ///< the clock as it is
  Clock* clock;       ///< that of the step's kernels
  Clock* room;        ///< on the host
  ShakingView shaking{};
  TALUS_HD unsigned* ticket() const { return &clock->ticket; }
  TALUS_HD void operator()(int = 0) const {
    Clock now = *from;  // read at once, not number by number as it is needed
    const bool opens = now.alarms.halt == running && now.steps_ahead > 0;
    if (opens) {
      --now.steps_ahead;
      now.begin_step();
      if (shaking.acts() && now.alarms.halt == running) now.shake(shaking.velocity_at(now.time));
    } else if (now.alarms.halt == running) {
      now.motion_maps.is_due = 0;
      now.halt_where_due();
    }
    *clock = now;
    if (!opens) *room = now;
  }
};

}  // namespace talus::solver
