// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over an index, on one thread or all; vectors and matrices of three against their definitions.
#include <algorithm>
#include <cstdlib>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "common/domain/threads.hpp"
#include "common/stage/machine.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/parallel/math.hpp"
#include "solver/parallel/pace.hpp"

namespace talus {
namespace {

struct CountVisits {
  int* visits;
  void operator()(int i) const { ++visits[i]; }
};

TEST(ForEach, visits_every_index_once) {
  for (const int count : {0, 1, 255, 256, 257, 5000}) {
    std::vector<int> visits(static_cast<std::size_t>(count) + 1);
    for_each(CpuDevice::make(), count, CountVisits{visits.data()});
    EXPECT_EQ(std::count(visits.begin(), visits.end() - 1, 1), count);
    EXPECT_EQ(visits.back(), 0) << "one behind the last of " << count;
  }
}

constexpr int block = 7, blocks = 40;  // points of a block; blocks of all four colours

/// One thread: one point. It counts the points before it in its block, and the earlier colours that are done.
struct Follow {
  int *place, *done, *earlier;
  void operator()(int p) const {
    place[p] = p % block == 0 ? 0 : place[p - 1] + 1;
    const int colour = p / block % 4;
    earlier[p] = 0;
    for (int c = 0; c < colour; ++c) earlier[p] += done[c] == block * blocks / 4 ? 1 : 0;
    atomic_increment(&done[colour]);
  }
};

TEST(ForEachGrouped, goes_colour_by_colour_and_through_each_block_in_order) {
  PointGroups groups;
  for (int b = 0; b < blocks; ++b) groups.ranges[b % 4].emplace_back(b * block, (b + 1) * block);
  std::vector<int> place(block * blocks, -1), earlier(block * blocks, -1);
  int done[4] = {};
  for_each_grouped(CpuDevice::make(), block * blocks, groups, Follow{place.data(), done, earlier.data()});
  for (int p = 0; p < block * blocks; ++p) {
    EXPECT_EQ(place[static_cast<std::size_t>(p)], p % block);
    EXPECT_EQ(earlier[static_cast<std::size_t>(p)], p / block % 4) << "colours done before point " << p;
  }
}

/// Counts the indices that another thread than `caller` ran.
struct CountStrangers {
  std::thread::id caller;
  std::atomic<int>* strangers;
  std::vector<int>* seen;
  void operator()(int i) const {
    if (std::this_thread::get_id() != caller) ++*strangers;
    (*seen)[static_cast<std::size_t>(i)] += 1;
  }
};

TEST(Alone, keeps_loops_on_the_calling_thread) {
  constexpr int count = 100'000;
  std::vector<int> seen(count, 0);
  std::atomic<int> strangers{0};
  const Alone alone;
  for (int loop = 0; loop < 8; ++loop)
    for_each(CpuDevice::make(), count, CountStrangers{std::this_thread::get_id(), &strangers, &seen});
  EXPECT_EQ(strangers, 0);
  EXPECT_EQ(seen, std::vector<int>(count, 8)) << "every index runs once a loop";
}

TEST(Alone, ends_where_it_began_and_is_of_one_thread) {
  EXPECT_FALSE(Alone::here());
  {
    const Alone outer;
    {
      const Alone inner;
      EXPECT_TRUE(Alone::here());
    }
    EXPECT_TRUE(Alone::here());
    EXPECT_TRUE(detail::is_single_threaded());
    bool other = true;
    std::thread([&] { other = Alone::here(); }).join();
    EXPECT_FALSE(other);
  }
  EXPECT_FALSE(Alone::here());
}

/// Seconds of `loops` loops that take so long alone and together, against what the better way takes.
double over_the_best(double alone, double together, int loops) {
  detail::LoopPace pace;
  double total = 0;
  for (int i = 0; i < loops; ++i) {
    const double seconds = pace.next_alone() ? alone : together;
    pace.note(seconds, 100);
    total += seconds;
  }
  return total / (loops * std::min(alone, together));
}

TEST(Pace, goes_the_way_that_takes_less_time) {
  EXPECT_LT(over_the_best(1e-3, 1e-4, 100000), 1.02) << "many cores";
  EXPECT_LT(over_the_best(5e-5, 1e-2, 100000), 1.2) << "waking takes 10 ms on a busy machine";
  EXPECT_LT(over_the_best(1e-3, 1e-3, 100000), 1.02);
}

TEST(Pace, comes_back_when_the_machine_is_free_again) {
  detail::LoopPace pace;
  int alone = 0;
  const auto loop = [&](double together) {
    const bool stays = pace.next_alone();
    alone += stays;
    pace.note(stays ? 1e-4 : together, 1);
  };
  for (int i = 0; i < 1000; ++i) loop(1e-2);
  EXPECT_GT(alone, 900);
  alone = 0;
  for (int i = 0; i < 50000; ++i) loop(2e-5);
  EXPECT_LT(alone, 10000);
}

TEST(Pace, sums_have_the_same_bits_on_one_thread_as_on_many) {
  const CpuDevice device = CpuDevice::make();
  const int count = 100003;  // no multiple of what is summed at a time
  std::vector<double> a, b;
  for (int i = 0; i < count; ++i) {
    a.push_back(std::sin(i) * std::pow(10, i % 17));
    b.push_back(std::cos(3 * i));
  }
  limit_threads_of_libraries(1);
  const double alone = inner_product(device, a.data(), b.data(), count);
  limit_threads_of_libraries(usable_threads() + 1);
  for (int i = 0; i < 200; ++i) ASSERT_EQ(inner_product(device, a.data(), b.data(), count), alone) << "loop " << i;
  limit_threads_of_libraries(usable_threads());
}

}  // namespace
}  // namespace talus

#ifdef __SANITIZE_THREAD__
namespace talus {
namespace {

struct AddToOnePlace {
  int* sum;
  void operator()(int) const { *sum += 1; }
};
struct AddToEach {
  int* sums;
  void operator()(int i) const { sums[i] += 1; }
};

TEST(LoopOrder, the_sanitizer_sees_pieces_that_write_to_one_place) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "this machine has one core";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        int sum = 0;
        for (int loop = 0; loop < 4; ++loop) for_each(CpuDevice::make(), 1 << 22, AddToOnePlace{&sum});
        std::exit(0);  // which the sanitizer turns into 66
      },
      testing::ExitedWithCode(66), "data race");
}

TEST(LoopOrder, loops_over_the_same_places_one_after_the_other_are_no_race) {
  const CpuDevice device = CpuDevice::make();
  Buffer<int, CpuDevice> sums(device);
  sums.upload(std::vector<int>(1 << 20, 0));
  for (int loop = 0; loop < 4; ++loop) for_each(device, 1 << 20, AddToEach{sums.data()});
  EXPECT_EQ(sums.download()[1 << 19], 4);
}

}  // namespace
}  // namespace talus
#endif
namespace talus {
namespace {

class Matrices : public ::testing::Test {
 protected:
  double number() { return spread_(engine_); }
  Vec3<double> vector() { return {number(), number(), number()}; }
  Mat3<double> matrix() { return {vector(), vector(), vector()}; }
  Sym3<double> symmetric() { return {number(), number(), number(), number(), number(), number()}; }

 private:
  std::mt19937 engine_{20261121};
  std::uniform_real_distribution<double> spread_{-1, 1};
};

void expect_near(const Vec3<double>& a, const Vec3<double>& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST_F(Matrices, inverse_undoes_the_matrix) {
  for (int n = 0; n < 200; ++n) {
    const Mat3<double> m = matrix();
    if (std::abs(determinant(m)) < 0.05) continue;  // rounding grows with the condition: 1e-12 holds up to there
    const Vec3<double> v = vector();
    expect_near(inverted(m) * (m * v), v, 1e-12);
  }
}

TEST_F(Matrices, inverse_of_a_symmetric_matrix_undoes_it) {
  for (int n = 0; n < 200; ++n) {
    const Sym3<double> s = symmetric().plus_identity(4);  // diagonally dominant
    const Vec3<double> v = vector();
    expect_near(inverted(s) * (s * v), v, 1e-13);
  }
}

TEST_F(Matrices, determinant_changes_sign_with_two_columns_and_is_that_of_the_volume) {
  const Mat3<double> m = matrix();
  EXPECT_DOUBLE_EQ(determinant(Mat3<double>{m.b, m.a, m.c}), -determinant(m));
  EXPECT_NEAR(determinant(m), dot(m.a, cross(m.b, m.c)), 1e-15);
}

TEST_F(Matrices, outer_product_maps_a_vector_as_it_should) {
  Mat3<double> m{};
  const Vec3<double> v = vector(), g = vector(), x = vector();
  add_outer(m, v, g);
  expect_near(m * x, v * dot(g, x), 1e-15);
}

TEST_F(Matrices, eigenvectors_are_orthonormal_and_compose_the_matrix_again) {
  for (int n = 0; n < 200; ++n) {
    const Sym3<double> s = symmetric();
    double values[3];
    Mat3<double> n3;
    eigen_symmetric(s, values, n3);
    EXPECT_NEAR(dot(n3.a, n3.a), 1, 1e-14);
    EXPECT_NEAR(dot(n3.a, n3.b), 0, 1e-14);
    EXPECT_NEAR(dot(n3.b, n3.c), 0, 1e-14);
    const Sym3<double> again = compose(values, n3);
    EXPECT_LT(norm_squared(again + s * -1.0), 1e-27);
  }
}

// Two eigenvalues 1e-9 apart: closed forms by angles lose the vectors there, rotations do not.
TEST_F(Matrices, nearly_equal_eigenvalues_keep_their_vectors) {
  const double angle = 0.3, c = std::cos(angle), d = std::sin(angle);
  const double given[3] = {1, 1 + 1e-9, 3};
  const Sym3<double> s = compose(given, Mat3<double>{{c, d, 0}, {-d, c, 0}, {0, 0, 1}});
  double values[3];
  Mat3<double> n3;
  eigen_symmetric(s, values, n3);
  EXPECT_LT(norm_squared(compose(values, n3) + s * -1.0), 1e-29);
  std::sort(values, values + 3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(values[k], given[k], 1e-14);
}

TEST_F(Matrices, multiple_of_the_identity_has_no_outlying_eigenvector) {
  const Vec3<double> none = outlying_eigenvector(Sym3<double>{2, 2, 2, 0, 0, 0});
  EXPECT_EQ(dot(none, none), 0);
  const Vec3<double> z = outlying_eigenvector(Sym3<double>{1, 1, 5, 0, 0, 0});
  EXPECT_NEAR(std::abs(z.z), 1, 1e-7);  // good to the square root of rounding
}

TEST_F(Matrices, commuting_product_is_the_product_of_powers) {
  const Sym3<double> s = symmetric(), square = commuting_product(s, s), cube = commuting_product(square, s);
  const Vec3<double> v = vector();
  expect_near(cube * v, s * (s * (s * v)), 1e-14);
}

TEST_F(Matrices, deviator_has_no_trace_and_keeps_the_shear) {
  const Sym3<double> s = symmetric(), d = deviator(s);
  EXPECT_NEAR(trace(d), 0, 1e-15);
  EXPECT_EQ(d.xy, s.xy);
}

}  // namespace
}  // namespace talus
