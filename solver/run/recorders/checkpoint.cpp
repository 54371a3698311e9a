// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/checkpoint.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "common/run/check_values.hpp"
#include "common/run/hdf5.hpp"
#include "common/run/history_group.hpp"
#include "common/run/sealed_file.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/stage.hpp"

namespace talus::solver {
namespace {

constexpr h5::Format checkpoint_format{"talus-checkpoint", "a checkpoint of this program"};
constexpr const char* points_group = "/points";
constexpr const char* homes = "/points/home";  // only there where steps were taken since points were sorted
constexpr const char* mend = "Run talus-solve again without --restart";

/// Calls item(field, name, list) for every list of the points that a checkpoint keeps, so that writing, reading and
/// checking cannot differ.
template <class State, class Item>
void visit_points(State& s, Item&& item) {
  const auto visit_one = [&](const ParticleField& field, int component, auto& list) {
    if (field.kept >= Kept::in_checkpoint) item(field, field.name_of(component), list);
  };
  visit_particle_fields(visit_one, s);
}

template <class Maps, class Item>
void visit_maps(Maps& m, Item&& item) {
  for_each_running_map([&](const RunningMap& map, auto& values) { item(map.name, values); }, m);
}

template <class Contacts, class Item>
void visit_contacts(Contacts& c, Item&& item) {
  item("force", c.force);
  item("impulse", c.impulse);
}

/// Visits all that a checkpoint holds beside points and history, group by group: items(group) is the visitor of one.
template <class AnyCheckpoint, class Items>
void visit(AnyCheckpoint& c, Items&& items) {
  visit_maps(c.state.maps, items("/maps"));
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

bool is_optional(const ParticleField& field) { return field.needed_by != &ParticleNeeds::always; }

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
    if (!is_optional(field) || tells(list, field.initial)) items(name, list);
  });
  if (!state.homes.empty()) file.write<std::int64_t>(homes, dims_of(state.homes.size()), state.homes);
}

void read_points(const h5::File& file, SolverState& state) {
  const ItemReader items(file, points_group);
  const auto lacks = [&](const ParticleField& field, const std::string& name) {
    return is_optional(field) && !file.exists(std::string(points_group) + "/" + name);
  };
  visit_points(state.points, [&](const ParticleField& field, const std::string& name, auto& list) {
    if (!lacks(field, name)) items(name, list);
  });
  visit_points(state.points, [&](const ParticleField& field, const std::string&, auto& list) {
    if (is_optional(field) && list.empty()) list.assign(state.points.size(), field.initial);
  });
  if (file.exists(homes)) state.homes = file.read_list<std::int64_t>(homes);
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
  visit_points(c.state.points,
               [&](const ParticleField&, const std::string& name, const auto& list) { points(name, list); });
  if (!c.state.homes.empty()) points("home", c.state.homes);
  OneLength maps(file, "/maps");
  visit_maps(c.state.maps, maps);
  visit_contacts(c.state.contacts, OneLength(file, "/contacts"));
  if (c.state.contacts.force.size() % 3 != 0)
    file.refuse(fmt::format("dataset /contacts/force has {} values", c.state.contacts.force.size()),
                "three belong together");
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  PendingFile pending(path);
  h5::File file = h5::File::create(pending.path(), {path, "Free some space, or name another folder with --out DIR"});
  file.leave_plain();  // a signal waits for it
  h5::set_format(file, checkpoint_format);
  file.set_text("/", "fingerprint", checkpoint.fingerprint);
  file.set_text("/", "id", checkpoint.id);
  file.set_text("/", "stop_reason", checkpoint.stop_reason);
  write_points(file, checkpoint.state);
  visit(checkpoint, [&](const char* group) { return ItemWriter(file, group); });
  write_history(file, checkpoint.memory.history);
  file.close();
  seal_file(pending.path(), path);
  pending.commit();
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

}  // namespace talus::solver
