// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Every field of the table is stored, sorted, copied to the host and counted; a field that is added is tested with
// them.
#include "solver/state/particles.hpp"

#include <numeric>
#include <set>

#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus {
namespace {

constexpr int count = 5;

/// A state in which no two numbers of a field are equal, and all are exact in single precision.
ParticleState sample() {
  ParticleState state;
  state.resize(count);
  int next = 1;
  visit_particle_fields(
      [&](const ParticleField&, int, auto& list) {
        list.resize(count);
        for (auto& number : list) number = static_cast<std::decay_t<decltype(number)>>(next++);
      },
      state);
  return state;
}

/// The needs of a run for which every field is there, and of one for which none is that could be left out.
constexpr ParticleNeeds everything{.affine_transfer = true,
                                   .plastic_volume = true,
                                   .boxes = true,
                                   .remapped_velocity = true,
                                   .accelerations = true,
                                   .loads = true,
                                   .spreads = true,
                                   .several_materials = true,
                                   .softening = true,
                                   .water = true};
constexpr ParticleNeeds nothing_more{};

/// Expects of every component of every field what `expected` says of its value at point p: expected(field, before, p).
template <class Expected>
void expect_fields(const ParticleState& after, const ParticleState& before, Kept least, std::size_t points,
                   Expected&& expected, const ParticleNeeds& needs = everything) {
  visit_particle_fields(
      [&](const ParticleField& field, int component, const auto& list, const auto& old) {
        const bool left_out = field.kept < least || (may_be_empty(field) && !(needs.*field.needed_by));
        ASSERT_EQ(list.size(), left_out ? 0 : points) << field.name_of(component);
        for (std::size_t p = 0; p < list.size(); ++p)
          EXPECT_EQ(list[p], expected(field, old, p)) << field.name_of(component) << " of point " << p;
      },
      after, before);
}

/// On every device, in both precisions.
class ParticlesOn : public solver::testing::OnEachDevice {
 protected:
  template <class Body>
  void in_both_precisions(Body&& body) {
    on_device([&](const auto& device) {
      body(float{}, device);
      body(double{}, device);
    });
  }
};

TEST(ParticleTable, names_are_unique_and_have_units) {
  std::set<std::string> names;
  for (const ParticleField& field : particle_fields) {
    EXPECT_TRUE(names.insert(field.name).second) << field.name;
    EXPECT_STRNE(field.unit, "") << field.name;
    EXPECT_GE(field.components, 1) << field.name;
  }
  EXPECT_EQ(particle_fields[0].name_of(2), "cell_2");
}

TEST(ParticleTable, components_that_are_kept_are_counted_by_their_numbers) {
  int whole = 0, real = 0;
  ParticleState state;
  visit_particle_fields(
      [&](const ParticleField& field, int, auto& list) {
        if (field.kept == Kept::within_step) return;
        ++(std::is_same_v<std::decay_t<decltype(list)>, std::vector<int>> ? whole : real);
      },
      state);
  EXPECT_EQ(components_kept(true), whole);
  EXPECT_EQ(components_kept(false), real);
}

TEST(ParticleTable, points_start_at_the_initial_values) {
  ParticleState state;
  state.resize(2);
  expect_fields(
      state, state, Kept::within_step, 2,
      [](const ParticleField& field, const auto&, std::size_t) { return field.initial; }, nothing_more);
  EXPECT_TRUE(state.load.empty()) << "not every run has loads";
  EXPECT_EQ(solver::testing::with_all_lists(state).load, (std::vector<int>{-1, -1}));
}

TEST(ParticleTable, places_are_what_a_kernel_moves_of_a_position) {
  EXPECT_EQ(ParticleView<double>::place_bytes, 36);
  EXPECT_EQ(ParticleView<float>::place_bytes, 24);
}

TEST_P(ParticlesOn, begin_at_initial_values_where_the_host_has_none) {
  in_both_precisions([](auto real, auto device) {
    ParticleState state;
    state.resize(count);
    ASSERT_TRUE(state.effective_stress.empty());
    Particles<decltype(real), decltype(device)> points(device, everything);
    points.upload(state);
    points.append(state);
    expect_fields(points.download(), state, Kept::in_checkpoint, 2 * count,
                  [](const ParticleField& field, const auto&, std::size_t) { return field.initial; });
  });
}

TEST_P(ParticlesOn, every_field_comes_back) {
  in_both_precisions([](auto real, auto device) {
    using Real = decltype(real);
    using Device = decltype(device);
    const ParticleState state = sample();
    Particles<Real, Device> points(device, everything);
    points.upload(state);
    EXPECT_EQ(points.count(), count);
    for (const Kept least : {Kept::in_checkpoint, Kept::in_frames}) {
      expect_fields(points.download(least), state, least, count,
                    [](const ParticleField&, const auto& old, std::size_t p) { return old[p]; });
    }
  });
}

TEST_P(ParticlesOn, fields_without_need_take_no_memory_and_read_as_initial) {
  in_both_precisions([](auto real, auto device) {
    using Real = decltype(real);
    using Device = decltype(device);
    const ParticleState state = sample();
    Particles<Real, Device> points(device, nothing_more);
    points.upload(state);
    std::size_t bytes = 0;
    const auto check = [&](const ParticleField& field, int component, auto* pointer) {
      const bool needed = nothing_more.*field.needed_by;
      EXPECT_EQ(pointer != nullptr, needed) << field.name_of(component);
      bytes += needed ? count * sizeof(*pointer) : 0;
    };
    auto view = points.view();
    visit_particle_fields(check, view);
    EXPECT_EQ(points.bytes(), bytes);
    expect_fields(
        points.download(), state, Kept::in_checkpoint, count,
        [](const ParticleField& field, const auto& old, std::size_t p) {
          return nothing_more.*field.needed_by ? old[p] : field.initial;
        },
        nothing_more);
  });
}

TEST_P(ParticlesOn, sorting_takes_every_field_along_and_drops_the_last) {
  in_both_precisions([](auto real, auto device) {
    using Real = decltype(real);
    using Device = decltype(device);
    const ParticleState state = sample();
    Particles<Real, Device> points(device, everything);
    points.upload(state);
    const std::vector<int> new_order{3, 0, 4, 1, 2};
    Buffer<int, Device> order(device);
    order.upload(new_order);
    points.reorder(order, 4);
    EXPECT_EQ(points.count(), 4);
    expect_fields(points.download(), state, Kept::in_checkpoint, 4,
                  [&](const ParticleField&, const auto& old, std::size_t p) {
                    return old[static_cast<std::size_t>(new_order[p])];
                  });
    points.reorder(order, 1);
    EXPECT_EQ(points.download().id, std::vector<int>{state.id[1]});
  });
}

using solver::testing::place_name;
TALUS_IN_EACH_PLACE(ParticlesOn);

}  // namespace
}  // namespace talus
