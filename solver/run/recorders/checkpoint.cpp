// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/checkpoint.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/run/hdf5.hpp"
#include "common/run/sealed_file.hpp"
#include "common/stage/files.hpp"
#include "common/stage/stage.hpp"
#include "solver/state/parts.hpp"

namespace talus::solver {
namespace {

constexpr h5::Format checkpoint_format{"talus-checkpoint", "a checkpoint of this program"};
constexpr const char* points_group = "/points";
constexpr const char* home_path = "/points/home";  // only there where steps were taken since points were sorted
constexpr const char* mend = "Run talus-solve again without --restart";

/// Calls item(field, name, list) for every list of the points in a checkpoint, to write, to read and to check.
template <class State, class Item>
void visit_points(State& s, Item&& item) {
  const auto visit_one = [&](const ParticleField& field, int component, auto& list) {
    if (field.kept >= Kept::in_checkpoint) item(field, field.name_of(component), list);
  };
  visit_particle_fields(visit_one, s);
}

template <class Contacts, class Item>
void visit_contacts(Contacts& c, Item&& item) {
  item("force", c.force);
  item("impulse", c.impulse);
}

/// Visits all that a checkpoint holds beside points and history, group by group: items(group) is the visitor of one.
template <class AnyCheckpoint, class Items>
void visit(AnyCheckpoint& c, Items&& items) {
  auto map_item = items("/maps");
  for_each_running_map([&](const RunningMap& map, auto& values) { map_item(map.name, values); }, c.state.maps);
  visit_contacts(c.state.contacts, items("/contacts"));
  visit_clock(c.state.clock, items("/clock"));
  visit_memory(c.memory, items("/memory"));
}

h5::Dims dims_of(std::size_t count) { return {static_cast<hsize_t>(count)}; }

/// Writes the items of one group: scalars as attributes, lists as datasets.
class ItemWriter {
 public:
  ItemWriter(h5::File& file, std::string group) : file_(file), group_(std::move(group)) { file_.make_group(group_); }

  void operator()(const std::string& name, const std::vector<int>& list) const {
    file_.write<std::int32_t>(group_ + "/" + name, dims_of(list.size()), list);
  }
  void operator()(const std::string& name, const std::vector<double>& list) const {
    file_.write<double>(group_ + "/" + name, dims_of(list.size()), list);
  }
  void operator()(const std::string& name, double number) const { file_.set_number(group_, name, number); }
  template <class Integer>
  requires std::is_integral_v<Integer>
  void operator()(const std::string& name, Integer count) const {
    file_.set_integer(group_, name, static_cast<std::int64_t>(count));
  }

 private:
  h5::File& file_;
  std::string group_;
};

/// Reads the items that ItemWriter wrote.
class ItemReader {
 public:
  ItemReader(const h5::File& file, std::string group) : file_(file), group_(std::move(group)) {}

  void operator()(const std::string& name, std::vector<int>& list) const {
    list = file_.read_list<std::int32_t>(group_ + "/" + name);
  }
  void operator()(const std::string& name, std::vector<double>& list) const {
    list = file_.read_list<double>(group_ + "/" + name);
    h5::check_values<double>(file_, group_ + "/" + name, list, h5::finite);
  }
  void operator()(const std::string& name, double& number) const {
    number = h5::checked_number(file_, group_, name, h5::finite);
  }
  template <class Integer>
  requires std::is_integral_v<Integer>
  void operator()(const std::string& name, Integer& count) const {
    const std::int64_t value = file_.integer(group_, name);
    if (!std::in_range<Integer>(value))
      file_.refuse(fmt::format("attribute {} {} is {}", group_, name, value), "it is out of range");
    count = static_cast<Integer>(value);
  }

 private:
  const h5::File& file_;
  std::string group_;
};

/// Whether a list says more than that every value is the initial one; -0 is not 0.
bool tells(const std::vector<int>& list, int initial) {
  return std::ranges::any_of(list, [&](int value) { return value != initial; });
}
bool tells(const std::vector<double>& list, int initial) {
  const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(initial));
  return std::ranges::any_of(list, [&](double value) { return std::bit_cast<std::uint64_t>(value) != bits; });
}

/// Fields that not every run needs are written where they tell anything: a signal waits for the file.
void write_points(h5::File& file, const SolverState& state) {
  const ItemWriter items(file, points_group);
  visit_points(state.points, [&](const ParticleField& field, const std::string& name, const auto& list) {
    if (!may_be_empty(field) || tells(list, field.initial)) items(name, list);
  });
  if (!state.homes.empty()) file.write<std::int64_t>(home_path, dims_of(state.homes.size()), state.homes);
}

void read_points(const h5::File& file, SolverState& state) {
  const ItemReader items(file, points_group);
  const auto lacks = [&](const ParticleField& field, const std::string& name) {
    return may_be_empty(field) && !file.exists(std::string(points_group) + "/" + name);
  };
  visit_points(state.points, [&](const ParticleField& field, const std::string& name, auto& list) {
    if (!lacks(field, name)) items(name, list);
  });
  if (file.exists(home_path)) state.homes = file.read_list<std::int64_t>(home_path);
}

/// Lists that must be of one length: those of the points, those of the map, those of the contact points.
class OneLength {
 public:
  OneLength(const h5::File& file, std::string group) : file_(file), group_(std::move(group)) {}

  void operator()(const std::string& name, const auto& list) {
    if (first_.empty()) {
      first_ = name;
      length_ = list.size();
    } else if (list.size() != length_) {
      file_.refuse(fmt::format("dataset {}/{} has {} values", group_, name, list.size()),
                   fmt::format("{} has {}", first_, length_));
    }
  }

 private:
  const h5::File& file_;
  std::string group_, first_;
  std::size_t length_ = 0;
};

void check_lengths(const h5::File& file, const Checkpoint& c) {
  OneLength points(file, points_group);
  visit_points(c.state.points, [&](const ParticleField& field, const std::string& name, const auto& list) {
    if (!may_be_empty(field) || !list.empty()) points(name, list);
  });
  if (!c.state.homes.empty()) points("home", c.state.homes);
  OneLength maps(file, "/maps");
  const auto visit_map = [&](const RunningMap& map, const auto& values) {
    if (map.of == MapsOf::every_run || !values.empty()) maps(map.name, values);
  };
  for_each_running_map(visit_map, c.state.maps);
  visit_contacts(c.state.contacts, OneLength(file, "/contacts"));
  if (c.state.contacts.force.size() % 3 != 0)
    file.refuse(fmt::format("dataset /contacts/force has {} values", c.state.contacts.force.size()),
                "three belong together");
}

/// Refuses one file, and looks at its lists.
class Fits {
 public:
  explicit Fits(const std::filesystem::path& file) : file_(file) {}

  [[noreturn]] void refuse(const std::string& why) const {
    refuse_file(file_, "the checkpoint does not fit the scene", why, "Run talus-solve again without --restart");
  }
  void length(const char* name, std::size_t found, std::size_t expected) const {
    if (found != expected) refuse(fmt::format("{} has {} values, the scene asks for {}", name, found, expected));
  }
  template <class T, class Low, class High>
  void within(const char* name, const std::vector<T>& values, Low low, High high) const {
    for (std::size_t p = 0; p < values.size(); ++p) {
      if (values[p] >= low && values[p] <= high) continue;
      refuse(fmt::format("{} of point {} is {}; {} to {} is possible", name, p, values[p], low, high));
    }
  }
  /// Refuses points that hold the same part of one seeded point.
  void all_different(const ParticleState& points, std::size_t count) const {
    std::vector<bool> taken(smallest_parts * count);
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Parts parts = parts_of(points, p);
      for (std::size_t part = parts.first; part < parts.first + parts.count; ++part) {
        if (taken[part]) refuse(fmt::format("two points have the id {} and share a piece of it", points.id[p]));
        taken[part] = true;
      }
    }
  }

 private:
  const std::filesystem::path& file_;
};

double largest(const std::vector<int>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

/// Homes are in the order of the sort, and no point has gone further from its own than a step may begin with.
void check_homes(const Fits& fits, const SolverState& state, const Scene& scene) {
  const std::vector<std::int64_t>& homes = state.homes;
  const int across = blocks_across(scene.grid.columns);
  const std::int64_t blocks = std::int64_t{across} * blocks_across(scene.grid.rows);
  fits.within("home", homes, 0, (blocks << key_block_shift) - 1);
  if (!std::is_sorted(homes.begin(), homes.end())) fits.refuse("its points are not in the order of their homes");
  const ParticleState& points = state.points;
  for (std::size_t p = 0; p < homes.size(); ++p) {
    const HomeCell home(across, static_cast<std::uint64_t>(homes[p]));
    const int cell[3] = {points.cell[0][p], points.cell[1][p], points.cell[2][p]};
    const bool here = cell[0] < 0 || (std::abs(cell[0] - home.i) <= 1 && std::abs(cell[1] - home.j) <= 1 &&
                                      std::abs(cell[2] - home.k) <= 1);
    if (home.i >= scene.grid.columns || home.j >= scene.grid.rows || !here)
      fits.refuse(fmt::format("home of point {} is cell {}, {}, {}; the point is in {}, {}, {}", p, home.i, home.j,
                              home.k, cell[0], cell[1], cell[2]));
  }
}

void check_points(const Fits& fits, const SolverState& state, std::int64_t pulses, const Scene& scene) {
  const ParticleState& points = state.points;
  constexpr double most_layers = 1 << 20, tiny = std::numeric_limits<double>::min();
  const std::size_t seeded = scene.points.size() + scene.inflow.points_in(pulses);
  if (points.size() > smallest_parts * seeded)
    fits.refuse(fmt::format("it holds {} points, of which the scene has {}", points.size(), seeded));
  fits.within("cell_0", points.cell[0], -1, scene.grid.columns - 1);
  const auto left = std::count(points.cell[0].begin(), points.cell[0].end(), -1);
  const int counted = state.homes.empty() ? 0 : state.clock.outflow.count;  // a sort drops those who have left
  if (left != counted) fits.refuse(fmt::format("{} of its points are outside, and its clock counts {}", left, counted));
  fits.within("cell_1", points.cell[1], 0, scene.grid.rows - 1);
  fits.within("cell_2", points.cell[2], 0, most_layers);
  for (const auto& offset : points.offset) fits.within("offset", offset, -0.5001, 0.5001);  // single precision rounds
  fits.within("volume", points.volume, tiny, 1e30);
  fits.within("id", points.id, 0, static_cast<double>(seeded) - 1);
  fits.within("piece", points.piece, 1, 2 * smallest_parts - 1);
  fits.all_different(points, seeded);
  fits.within("release", points.release, 0, static_cast<double>(scene.release_names.size()) - 1);
  fits.within("load", points.load, -1, static_cast<double>(scene.load_volumes.size()) - 1);
  fits.within("material", points.material, 0,
              std::max(largest(scene.points.material), largest(scene.inflow.points.material)));
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  const auto write = [&](h5::File& file) {
    file.leave_plain();  // a signal waits for it
    h5::set_format(file, checkpoint_format);
    file.set_text("/", "fingerprint", checkpoint.fingerprint);
    file.set_text("/", "id", checkpoint.id);
    file.set_text("/", "stop_reason", checkpoint.stop_reason);
    write_points(file, checkpoint.state);
    visit(checkpoint, [&](const char* group) { return ItemWriter(file, group); });
    write_history(file, checkpoint.memory.history);
  };
  h5::write_sealed(path, write, "Free some space, or name another folder with --out DIR");
}

std::optional<CheckpointHead> look_at_checkpoint(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  try {
    const h5::File file = h5::open_sealed(path, {path, mend}, checkpoint_format);
    return CheckpointHead{file.text("/", "fingerprint"), file.number("/clock", "time"), file.integer("/clock", "step")};
  } catch (const DataError&) {
    return std::nullopt;  // broken, or of another version
  }
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const std::string& fingerprint) {
  const h5::File file = h5::open_sealed(path, {path, mend}, checkpoint_format);
  Checkpoint c;
  c.fingerprint = file.text("/", "fingerprint");
  if (c.fingerprint != fingerprint) {
    throw DataError({path.string() + ": the checkpoint belongs to another domain or other [solve] settings",
                     "going on from it would mix two runs",
                     "Restore the recipe and domain.vdb it was made with, or run talus-solve without --restart"});
  }
  c.id = file.text("/", "id");
  c.stop_reason = file.text("/", "stop_reason");
  read_points(file, c.state);
  visit(c, [&](const char* group) { return ItemReader(file, group); });
  c.memory.history = read_history(file);
  check_lengths(file, c);
  return c;
}

void check_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, const Scene& scene) {
  const Fits fits(file);
  const std::int64_t pulses = checkpoint.memory.pulses;
  if (pulses < 0 || pulses > std::ssize(scene.inflow.pulses))
    fits.refuse(fmt::format("{} pulses of inflows have entered, of which the scene has {}", pulses,
                            scene.inflow.pulses.size()));
  check_points(fits, checkpoint.state, pulses, scene);
  check_homes(fits, checkpoint.state, scene);
  const std::size_t cells = scene.map.count();
  const auto check_map = [&](const RunningMap& map, const auto& values) {
    const bool kept = map.of == MapsOf::every_run || (map.of == MapsOf::water_in_pores && !scene.water_table.empty());
    fits.length(map.name, values.size(), map.of == MapsOf::erosion_by_rate ? scene.erodible.size() : kept ? cells : 0);
  };
  for_each_running_map(check_map, checkpoint.state.maps);
  fits.length("initial_thickness", checkpoint.memory.initial_thickness.size(), cells);
  const ContactState& contacts = checkpoint.state.contacts;
  const std::size_t count = contacts.force.empty() ? 0 : 3 * scene.contacts.size();
  fits.length("force", contacts.force.size(), count);
  fits.length("impulse", contacts.impulse.size(), count);
  const Clock& clock = checkpoint.state.clock;
  const bool counted = clock.step >= 0 && clock.outflow.count >= 0 && clock.sorting.steps_between > 0 &&
                       clock.alarms.halt >= running && clock.alarms.halt <= failed && clock.alarms.request >= running &&
                       clock.alarms.request <= failed;
  if (!(clock.time >= 0) || !(clock.step_size >= 0) || !(clock.control.courant >= 0) || !counted)
    fits.refuse(fmt::format("its clock stands at {:g} s, step {}, of {:g} s", clock.time, clock.step, clock.step_size));
  const RunMemory& memory = checkpoint.memory;
  if (std::min({memory.frames, memory.records, memory.checkpoints, memory.outflow_count}) < 0)
    fits.refuse("its counts of frames, records, checkpoints or points that left are negative");
}

}  // namespace talus::solver
