// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/check_checkpoint.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "common/stage/write_fault.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {
namespace {

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
  void all_different(const char* name, const std::vector<int>& values, std::size_t count) const {
    std::vector<bool> taken(count);
    for (const int value : values) {
      const auto place = static_cast<std::size_t>(value);
      if (taken[place]) refuse(fmt::format("two points have the {} {}", name, value));
      taken[place] = true;
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
  if (points.size() > seeded)
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
  fits.all_different("id", points.id, seeded);
  fits.within("release", points.release, 0, static_cast<double>(scene.release_names.size()) - 1);
  fits.within("load", points.load, -1, static_cast<double>(scene.load_volumes.size()) - 1);
  fits.within("material", points.material, 0,
              std::max(largest(scene.points.material), largest(scene.inflow.points.material)));
}

}  // namespace

void check_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, const Scene& scene) {
  const Fits fits(file);
  const std::int64_t pulses = checkpoint.memory.pulses;
  if (pulses < 0 || pulses > std::ssize(scene.inflow.pulses))
    fits.refuse(fmt::format("{} pulses of inflows have entered, of which the scene has {}", pulses,
                            scene.inflow.pulses.size()));
  check_points(fits, checkpoint.state, pulses, scene);
  check_homes(fits, checkpoint.state, scene);
  const std::size_t cells = scene.map.count();
  for_each_running_map([&](const RunningMap& map, const auto& values) { fits.length(map.name, values.size(), cells); },
                       checkpoint.state.maps);
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
