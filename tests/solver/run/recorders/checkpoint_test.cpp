// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A checkpoint gives back, bit for bit, all that was written, and other files are refused in words.
#include "solver/run/recorders/checkpoint.hpp"

#include <bit>
#include <set>

#include "common/run/sealed_file.hpp"
#include "common/stage/checksum.hpp"
#include "solver/boundary/contact_points.hpp"
#include "solver/state/particles.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver {
namespace {

using test::fault_of;
using test::Scratch;
using testing::place_name;

/// Converts to anything: for counting the members of an aggregate.
struct Anything {
  template <class T>
  operator T() const;
};

/// Members of an aggregate, each element of an array counted.
template <class T, class... Members>
constexpr std::size_t member_count() {
  if constexpr (requires { T{Members{}..., Anything{}}; }) {
    return member_count<T, Members..., Anything>();
  } else {
    return sizeof...(Members);
  }
}

/// Gives every item another value that its type just holds.
struct FillItems {
  int filled = 0;
  void operator()(const char*, double& number) { number = 1.0 / (3 + filled++); }
  void operator()(const char*, std::int64_t& number) { number = (std::int64_t{1} << 60) + filled++; }
  void operator()(const char*, std::uint32_t& number) { number = 0xffffff00U + static_cast<std::uint32_t>(filled++); }
  void operator()(const char*, int& number) { number = -1000 - filled++; }
  void operator()(const char*, std::vector<double>& list) { list.assign(5, 1.0 / (3 + filled++)); }
};

/// Collects items as the bits that they are.
struct CollectBits {
  std::vector<std::pair<std::string, std::uint64_t>> bits;
  void operator()(const char* name, double number) { bits.emplace_back(name, std::bit_cast<std::uint64_t>(number)); }
  template <class Integer>
  requires std::is_integral_v<Integer>
  void operator()(const char* name, Integer number) { bits.emplace_back(name, static_cast<std::uint64_t>(number)); }
  void operator()(const char* name, const std::vector<double>& list) {
    for (const double number : list) (*this)(name, number);
  }
};

auto clock_bits(const Clock& clock) {
  CollectBits collect;
  visit_clock(clock, collect);
  return collect.bits;
}

auto memory_bits(const RunMemory& memory) {
  CollectBits collect;
  visit_memory(memory, collect);
  return collect.bits;
}

Domain three_points() {
  return testing::filled(testing::ground(12, 12, 10, 5, [](double x, double) { return 0.1 * x; }),
                         {50, 60, 50, 60, 0, 5}, 1, 1);
}

/// A checkpoint of three points whose clock and memory hold no two equal numbers.
Checkpoint sample() {
  Checkpoint c;
  c.fingerprint = "a domain and its settings";
  c.id = "0123456789abcdef";
  c.stop_reason = "end of the simulated time";
  const SolveOptions options;
  const Scene scene = make_scene(three_points(), options);
  c.state = testing::first_state(scene, make_settings(options, scene.grid).common);
  c.state.maps.peak_speed[7] = std::numeric_limits<double>::denorm_min();
  c.state.contacts = {{1, 2, 3}, {-0.0, 5, 6}};
  FillItems fill;
  visit_clock(c.state.clock, fill);
  visit_memory(c.memory, fill);
  c.memory.history.columns = {{.name = "time_s", .unit = "s", .quantity = "", .place = "", .values = {0, 0.1}},
                              {.name = "a_later_column", .unit = "m", .quantity = "q", .place = "p", .values = {7, 8}}};
  return c;
}

/// The number of scalars of a clock, whose other members are the structs `Parts`.
template <class... Parts>
constexpr std::size_t clock_scalars() {
  return member_count<Clock>() - sizeof...(Parts) + (member_count<Parts>() + ...);
}

TEST(Checkpoint, visits_name_every_member_once) {
  const auto names = [](const auto& bits) {
    std::set<std::string> set;
    for (const auto& [name, value] : bits) set.insert(name);
    return set.size();
  };
  constexpr std::size_t scalars = clock_scalars<Alarms, StepControl, SubgridVelocity, SortPolicy, Outflow,
                                                MotionMapPolicy, WaterPolicy, GroundMotion, EnergyBudget>() -
                                  2;  // steps_ahead and ticket, of a batch, which is over where a state is saved
  EXPECT_EQ(names(clock_bits(Clock{})), scalars);
  EXPECT_EQ(clock_bits(Clock{}).size(), scalars);
  RunMemory memory;
  memory.initial_thickness = memory.section_x = memory.section_y = {1};
  EXPECT_EQ(names(memory_bits(memory)), member_count<RunMemory>() - 1) << "the history has columns of its own";
}

TEST(Checkpoint, every_scalar_comes_back_bit_for_bit) {
  const Scratch scratch;
  const Checkpoint c = sample();
  write_checkpoint(scratch / "checkpoint.h5", c);
  EXPECT_EQ(scratch.files(), 1u);
  const Checkpoint back = read_checkpoint(scratch / "checkpoint.h5", c.fingerprint);
  EXPECT_EQ(back.id, c.id);
  EXPECT_EQ(back.stop_reason, c.stop_reason);
  EXPECT_EQ(clock_bits(back.state.clock), clock_bits(c.state.clock));
  EXPECT_EQ(memory_bits(back.memory), memory_bits(c.memory));
  EXPECT_EQ(back.memory.pulses, c.memory.pulses);
  ASSERT_EQ(back.memory.history.columns.size(), 2u);
  for (std::size_t column = 0; column < 2; ++column) {
    EXPECT_EQ(back.memory.history.columns[column].name, c.memory.history.columns[column].name);
    EXPECT_EQ(back.memory.history.columns[column].unit, c.memory.history.columns[column].unit);
    EXPECT_EQ(back.memory.history.columns[column].values, c.memory.history.columns[column].values);
  }
  EXPECT_EQ(back.state.maps.peak_speed, c.state.maps.peak_speed);
  EXPECT_EQ(back.state.maps.arrival_time, c.state.maps.arrival_time);
  EXPECT_EQ(back.state.contacts.force, c.state.contacts.force);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(back.state.contacts.impulse[0]), std::bit_cast<std::uint64_t>(-0.0));
}

/// Sand that slides out of the domain.
struct Sliding {
  static constexpr double event = 10;  ///< to which steps are even [s]
  SolveOptions options;
  Scene scene;

  explicit Sliding(const SolveOptions& asked) : options(asked) {
    Domain domain = testing::ground(24, 16, 10, 5, [](double x, double) { return 0.4 * x; });
    testing::fill(domain, {60, 120, 50, 110, 0, 20});
    options.largest_step = 0.05;
    scene = make_scene(domain, options);
  }
  std::unique_ptr<Solver> from_start(const AnyDevice& device) const {
    auto solver = make_solver(scene, options, device);
    solver->set_next_event(event);
    return solver;
  }
  /// The state as --restart gets it.
  SolverState through_a_file(const SolverState& state) const {
    const Scratch scratch;
    Checkpoint checkpoint{"fingerprint", "a1", "", state, {}};
    checkpoint.memory.initial_thickness.assign(scene.map.count(), 0.0);
    write_checkpoint(scratch / "checkpoint.h5", checkpoint);
    const Checkpoint back = read_checkpoint(scratch / "checkpoint.h5", "fingerprint");
    check_checkpoint(scratch / "checkpoint.h5", back, scene);
    EXPECT_EQ(back.state.homes, state.homes);
    testing::expect_same_points(back.state.points, state.points);
    return back.state;
  }
};

long points_outside(const SolverState& state) {
  return std::count_if(state.points.cell[0].begin(), state.points.cell[0].end(), [](int cell) { return cell < 0; });
}

/// Taken through a file after a sort and at every seventh step until the next but one, against a run without a break.
TEST(Checkpoint, a_run_goes_on_from_a_file_bit_for_bit) {
  std::vector<SolveOptions> ways(4);
  ways[1].precision = Precision::single_;
  ways[2].integrator = Integrator::column_implicit;
  ways[3].shape = ShapeKind::gimp;
  ways[3].material.model = MaterialModel::mu_of_i;
  for (const SolveOptions& way : ways) {
    SCOPED_TRACE(&way - ways.data());
    const Sliding sliding(way);
    const auto unbroken = sliding.from_start(CpuDevice::make());
    BatchReport batch;
    while (batch.outflow_count == 0) batch = unbroken->advance();  // until a sort has dropped some
    std::vector<std::unique_ptr<Solver>> resumed;
    long outside = 0;
    for (int sorts = 0, step = 0; sorts < 2; ++step, sorts += batch.sorted ? 1 : 0) {
      EXPECT_TRUE(batch.can_be_saved);
      const SolverState state = unbroken->state();
      EXPECT_EQ(state.homes.empty(), batch.sorted);
      outside = std::max(outside, points_outside(state));
      if (step % 7 == 0)
        resumed.push_back(
            resume_solver(sliding.scene, sliding.options, CpuDevice::make(), sliding.through_a_file(state)));
      batch = unbroken->advance();
    }
    EXPECT_GT(outside, 0) << "points that have left wait for a sort";
    EXPECT_GT(resumed.size(), 4u);
    constexpr double end = Sliding::event;
    EXPECT_LT(unbroken->clock().time, end - 0.5);
    testing::run_to(*unbroken, end);
    const SolverState one = unbroken->state();
    for (const auto& solver : resumed) {
      testing::run_to(*solver, end);
      const SolverState other = solver->state();
      EXPECT_EQ(clock_bits(other.clock), clock_bits(one.clock));
      testing::expect_same_points(other.points, one.points);
      EXPECT_EQ(other.maps.peak_speed, one.maps.peak_speed);
    }
  }
}

class CheckpointBetweenSorts : public testing::InEachPlace {};

TEST_P(CheckpointBetweenSorts, leads_to_the_same_slide_wherever_the_run_goes_on) {
  SolveOptions options;
  options.shape = ShapeKind::gimp;  // points are not split: that is done at sorts, which come at other times on a GPU
  const Sliding sliding(options);
  const auto unbroken = sliding.from_start(CpuDevice::make());
  double left = 0;
  while (points_outside(unbroken->state()) == 0) left += unbroken->advance().outflow_volume;
  const auto resumed =
      resume_solver(sliding.scene, sliding.options, make_device(GetParam()), sliding.through_a_file(unbroken->state()));
  double after[2] = {left, left};
  const double end = unbroken->clock().time + 1;
  for (int n = 0; n < 2; ++n) {
    testing::run_to(n == 0 ? *unbroken : *resumed, end,
                    [&](const BatchReport& batch) { after[n] += batch.outflow_volume; });
  }
  const Energies a = unbroken->energies(), b = resumed->energies();
  EXPECT_GT(after[0], left);
  EXPECT_NEAR(after[1], after[0], 1e-9 * after[0]);
  EXPECT_NEAR(b.volume, a.volume, 1e-9 * a.volume);
  EXPECT_NEAR(b.kinetic / a.kinetic, 1, 1e-6);  // as on a GPU without a break (Places, agree_on_a_slide)
}
TALUS_IN_EACH_PLACE(CheckpointBetweenSorts);

TEST(Checkpoint, a_look_at_it_tells_whose_it_is_and_how_far_it_is) {
  const Scratch scratch;
  const auto path = scratch / "checkpoint.h5";
  EXPECT_FALSE(look_at_checkpoint(path).has_value());
  std::ofstream(path) << "no checkpoint";
  EXPECT_FALSE(look_at_checkpoint(path).has_value());
  const Checkpoint c = sample();
  write_checkpoint(path, c);
  const auto head = look_at_checkpoint(path);
  ASSERT_TRUE(head.has_value());
  EXPECT_EQ(head->fingerprint, c.fingerprint);
  EXPECT_EQ(head->time, c.state.clock.time);
  EXPECT_EQ(head->step, c.state.clock.step);
}

TEST(Checkpoint, a_changed_byte_is_noticed) {
  const Scratch scratch;
  write_checkpoint(scratch / "checkpoint.h5", sample());
  std::string bytes = test::text_of(scratch / "checkpoint.h5");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  const auto changed = scratch.write("changed.h5", bytes);
  EXPECT_TRUE(test::holds(fault_of<DataError>([&] { read_checkpoint(changed, ""); }),
                          {"is damaged (bytes have changed since"}));
}

TEST(Checkpoint, lists_of_different_lengths_are_refused) {
  const auto fault_with = [](const auto& change) {
    const Scratch scratch;
    Checkpoint c = sample();
    change(c);
    write_checkpoint(scratch / "c.h5", c);
    const std::string fault = fault_of<DataError>([&] { read_checkpoint(scratch / "c.h5", c.fingerprint); });
    return fault.empty() ? fault : fault.substr((scratch / "c.h5").string().size());
  };
  const auto refused = [&](const auto& change, const std::string& words) {
    EXPECT_TRUE(fault_with(change).starts_with(words)) << words;
  };
  EXPECT_EQ(fault_with([](Checkpoint&) {}), "");
  refused([](Checkpoint& c) { c.state.points.velocity[1].pop_back(); },
          ": dataset /points/velocity_1 has 0 values (cell_0 has 1)");
  refused([](Checkpoint& c) { c.state.maps.peak_speed.push_back(0); },
          ": dataset /maps/peak_speed has 145 values (peak_thickness has 144)");
  refused([](Checkpoint& c) { c.state.contacts.impulse.clear(); },
          ": dataset /contacts/impulse has 0 values (force has 3)");
  refused([](Checkpoint& c) { c.state.points.offset[0][0] = std::nan(""); },
          ": dataset /points/offset_0 holds nan at place 0 (-5e+29 to 5e+29 is possible)");
}

TEST(Checkpoint, what_does_not_fit_the_scene_is_refused_before_a_kernel_sees_it) {
  const SolveOptions options;
  const Scene scene = make_scene(three_points(), options);
  const auto fault_with = [&](const auto& change) {
    Checkpoint c;
    c.state = testing::first_state(scene, make_settings(options, scene.grid).common);
    c.state.points = testing::with_all_lists(c.state.points);
    c.memory.initial_thickness.assign(scene.map.count(), 0.0);
    change(c);
    return fault_of<DataError>([&] { check_checkpoint("c.h5", c, scene); });
  };
  const std::string no_fit = "c.h5: the checkpoint does not fit the scene (";
  const auto refused = [&](const auto& change, const std::string& words) {
    EXPECT_TRUE(fault_with(change).starts_with(words)) << words;
  };
  EXPECT_EQ(fault_with([](Checkpoint&) {}), "");
  refused([](Checkpoint& c) { c.state.points.cell[1][0] = 12; },
          no_fit + "cell_1 of point 0 is 12; 0 to 11 is possible)");
  refused([](Checkpoint& c) { c.state.points.offset[2][0] = 1; }, no_fit + "offset of");
  refused([](Checkpoint& c) { c.state.points.id[0] = -1; }, no_fit + "id of point 0 is -1");
  refused([](Checkpoint& c) { c.state.points.material[0] = 1; }, no_fit + "material of");
  refused([](Checkpoint& c) { c.state.points.load[0] = 0; }, no_fit + "load of point 0");
  refused([](Checkpoint& c) { c.state.points.id.assign(5, 0); }, no_fit + "it holds 5 points");
  refused(
      [](Checkpoint& c) {
        const auto twice = [](const ParticleField&, int, auto& list) {
          if (!list.empty()) list.push_back(list[0]);
        };
        visit_particle_fields(twice, c.state.points);
        c.state.points.piece = {2, 5};
      },
      no_fit + "two points have the id 0 and share a piece of it)");
  refused([](Checkpoint& c) { c.state.points.piece[0] = 8; }, no_fit + "piece of point 0 is 8; 1 to 7 is possible)");
  refused([](Checkpoint& c) { c.state.maps.peak_speed.pop_back(); },
          no_fit + "peak_speed has 143 values, the scene asks for 144)");
  refused([](Checkpoint& c) { c.state.contacts.force = {1, 2, 3}; }, no_fit + "force has 3");
  refused([](Checkpoint& c) { c.state.clock.alarms.halt = 9; }, no_fit + "its clock stands at");
  refused([](Checkpoint& c) { c.state.points.cell[0][0] = -1; },
          no_fit + "1 of its points are outside, and its clock counts 0)");
  // Homes are the cells (5, 5, 0) of the one point, or others.
  const auto home = [](int i, int j, int k) {
    return [key = home_key(blocks_across(12), i, j, k)](Checkpoint& c) {
      c.state.homes.assign(c.state.points.size(), static_cast<std::int64_t>(key));
    };
  };
  const int at[3] = {scene.points.cell[0][0], scene.points.cell[1][0], scene.points.cell[2][0]};
  EXPECT_EQ(fault_with(home(at[0], at[1], at[2])), "");
  EXPECT_EQ(fault_with(home(at[0] + 1, at[1] - 1, at[2] + 1)), "");
  refused(home(at[0] + 2, at[1], at[2]), no_fit + "home of point 0 is cell");
  refused(home(at[0], at[1], at[2] + 2), no_fit + "home of point 0 is cell");
  refused([](Checkpoint& c) { c.state.homes = {-1}; }, no_fit + "home of point 0 is -1");
  refused(home(at[0], 12, at[2]), no_fit + "home of point 0 is ");
}

TEST(Checkpoint, another_format_is_refused) {
  const Scratch scratch;
  const auto path = scratch / "checkpoint.h5";
  h5::File file = h5::File::create(path, {path, ""});
  h5::set_format(file, {"talus-checkpoint", "", 7});
  file.close();
  seal_file(path, path);
  EXPECT_EQ(fault_of<DataError>([&] { read_checkpoint(path, ""); }),
            path.string() + ": format 7 (this version reads 1). Run talus-solve again without --restart");
}

TEST(Checkpoint, other_files_are_refused_in_words) {
  const Scratch scratch;
  const auto path = scratch / "checkpoint.h5";
  EXPECT_EQ(fault_of<DataError>([&] { read_checkpoint(path, ""); }),
            path.string() + ": no such file. Run talus-solve again without --restart");
  h5::File file = h5::File::create(path, {path, ""});
  file.close();
  seal_file(path, path);
  EXPECT_EQ(fault_of<DataError>([&] { read_checkpoint(path, ""); }),
            path.string() +
                ": is not a checkpoint of this program (its mark is missing). Run talus-solve again without --restart");
  write_checkpoint(path, sample());
  EXPECT_TRUE(fault_of<DataError>([&] {
                read_checkpoint(path, "another one");
              }).starts_with(path.string() + ": the checkpoint belongs to another domain or other [solve] settings ("));
}

}  // namespace
}  // namespace talus::solver
