#include "solver/run/recorders/checkpoint.hpp"

#include <cstring>
#include <span>

#include <fmt/format.h>

#include "common/run/hdf5.hpp"
#include "common/run/history_group.hpp"
#include "common/stage/stage.hpp"

namespace talus::solver {
namespace {

constexpr const char* kind = "talus checkpoint 4";

/// Visits every array of the points by name, so that writing and reading cannot differ.
template <class State, class Ints, class Reals>
void visit_points(State& s, Ints&& ints, Reals&& reals) {
  for (int a = 0; a < 3; ++a) {
    ints(fmt::format("cell_{}", a), s.cell[a]);
    reals(fmt::format("offset_{}", a), s.offset[a]);
    reals(fmt::format("extent_{}", a), s.extent[a]);
    reals(fmt::format("velocity_{}", a), s.velocity[a]);
    reals(fmt::format("acceleration_{}", a), s.acceleration[a]);
  }
  for (int a = 0; a < 9; ++a) reals(fmt::format("affine_{}", a), s.affine[a]);
  for (int a = 0; a < 6; ++a) reals(fmt::format("elastic_{}", a), s.elastic[a]);
  ints("id", s.id);
  ints("release", s.release);
  ints("load", s.load);
  ints("material", s.material);
  reals("plastic_shear", s.plastic_shear);
  reals("log_volume", s.log_volume);
  reals("plastic_log_volume", s.plastic_log_volume);
  reals("volume", s.volume);
}

template <class Maps, class Reals>
void visit_maps(Maps& m, Reals&& reals) {
  reals("peak_thickness", m.peak_thickness);
  reals("peak_speed", m.peak_speed);
  reals("peak_pressure", m.peak_pressure);
  reals("arrival", m.arrival);
}

template <class Contacts, class Reals>
void visit_contacts(Contacts& c, Reals&& reals) {
  reals("contact_force", c.force);
  reals("contact_impulse", c.impulse);
}

h5::Dims dims_of(std::size_t count) { return {static_cast<hsize_t>(count)}; }

void write_memory(h5::File& file, const RunMemory& m) {
  file.make_group("/memory");
  const std::int64_t counts[] = {m.frames, m.records, m.checkpoints, m.outflow_count, m.newton, m.linear, m.cuts};
  file.write<std::int64_t>("/memory/event_counts", {7}, counts);
  const double numbers[] = {m.peak_kinetic, m.outflow_volume, m.wall_time};
  file.write<double>("/memory/numbers", {3}, numbers);
  file.write<double>("/memory/initial_thickness", dims_of(m.initial_thickness.size()), m.initial_thickness);
  write_history(file, m.history);
}

RunMemory read_memory(const h5::File& file) {
  RunMemory m;
  const auto counts = file.read<std::int64_t>("/memory/event_counts");
  const auto numbers = file.read<double>("/memory/numbers", {3});
  m.frames = counts.at(0);
  m.records = counts.at(1);
  m.checkpoints = counts.at(2);
  m.outflow_count = counts.at(3);
  m.newton = counts.at(4);
  m.linear = counts.at(5);
  m.cuts = counts.at(6);
  m.peak_kinetic = numbers[0];
  m.outflow_volume = numbers[1];
  m.wall_time = numbers[2];
  m.initial_thickness = file.read<double>("/memory/initial_thickness");
  m.history = read_history(file);
  return m;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  PendingFile pending(path);
  h5::File file = h5::File::create(pending.path(), {path, "Free some space, or name another folder with --out DIR"});
  file.set_text("/", "kind", kind);
  file.set_text("/", "fingerprint", checkpoint.fingerprint);
  file.make_group("/points");
  visit_points(
      checkpoint.state.points,
      [&](const std::string& name, const std::vector<int>& v) {
        file.write<std::int32_t>("/points/" + name, dims_of(v.size()), v);
      },
      [&](const std::string& name, const std::vector<double>& v) {
        file.write<double>("/points/" + name, dims_of(v.size()), v);
      });
  file.make_group("/maps");
  visit_maps(checkpoint.state.maps, [&](const std::string& name, const std::vector<double>& v) {
    file.write<double>("/maps/" + name, dims_of(v.size()), v);
  });
  visit_contacts(checkpoint.state.contacts, [&](const std::string& name, const std::vector<double>& v) {
    file.write<double>("/" + name, dims_of(v.size()), v);
  });
  std::vector<std::uint8_t> clock(sizeof(Clock));
  std::memcpy(clock.data(), &checkpoint.state.clock, sizeof(Clock));
  file.write<std::uint8_t>("/clock", dims_of(clock.size()), clock);
  write_memory(file, checkpoint.memory);
  file.close();
  pending.commit();
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const std::string& fingerprint) {
  const h5::File file = h5::File::open(path, {path, "Run talus-solve again without --restart"});
  if (!file.has_attribute("/", "kind") || file.text("/", "kind") != kind)
    file.fail("this is no checkpoint of this program");
  Checkpoint c;
  c.fingerprint = file.text("/", "fingerprint");
  if (c.fingerprint != fingerprint) {
    throw DataError({path.string() + ": the checkpoint belongs to another domain or other [solve] settings",
                     "going on from it would mix two runs",
                     "Restore the recipe and domain.vdb it was made with, or run talus-solve without --restart"});
  }
  visit_points(
      c.state.points,
      [&](const std::string& name, std::vector<int>& v) { v = file.read<std::int32_t>("/points/" + name); },
      [&](const std::string& name, std::vector<double>& v) { v = file.read<double>("/points/" + name); });
  visit_maps(c.state.maps,
             [&](const std::string& name, std::vector<double>& v) { v = file.read<double>("/maps/" + name); });
  visit_contacts(c.state.contacts,
                 [&](const std::string& name, std::vector<double>& v) { v = file.read<double>("/" + name); });
  const auto clock = file.read<std::uint8_t>("/clock", dims_of(sizeof(Clock)));
  std::memcpy(static_cast<void*>(&c.state.clock), clock.data(), sizeof(Clock));
  c.memory = read_memory(file);
  return c;
}

}  // namespace talus::solver
