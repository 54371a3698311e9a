// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a GPU's state keeps for the next call; there is none where the program was built without CUDA.
#include <numeric>

#include "solver/parallel/macros.hpp"
#if TALUS_FOR_GPU
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/gpu_state.hpp"
#include "solver/parallel/peers.hpp"
#endif
#include "solver/scene/make_scene.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

class GpuStates : public InEachPlace {};

TEST_P(GpuStates, lend_memory_that_was_given_back_before_they_take_more) {
#if TALUS_FOR_GPU
  const GpuDevice device = GpuDevice::make();
  const auto address_of = [&](std::size_t bytes) { return Buffer<char, GpuDevice>(device, bytes).data(); };
  const Buffer<char, GpuDevice> held(device, 10000);
  const char* const first = address_of(10000);
  EXPECT_NE(first, held.data());
  EXPECT_EQ(address_of(9500), first) << "the size that both are rounded up to is the same";
  EXPECT_NE(address_of(5000), first) << "half of it would lie idle";
  const std::size_t large = StreamMemory::most_kept + 1;
  EXPECT_NE(address_of(large), nullptr);
  EXPECT_NE(address_of(large), nullptr);
#endif
}

TEST_P(GpuStates, tell_which_call_of_cuda_failed) {
#if TALUS_FOR_GPU
  EXPECT_NO_THROW(check_cuda(cudaSuccess, "nothing"));
  EXPECT_THROW(check_cuda(cudaErrorMemoryAllocation, "a test's allocation"), NumericalError);
  EXPECT_THROW(check_cuda(cudaErrorInvalidValue, "a test's call"), std::runtime_error);
#endif
}

#if TALUS_FOR_GPU
/// Two parts of one GPU as one device, which share kernels of so many threads.
GpuDevice two_parts(std::int64_t share_from) {
  const GpuDevice device = GpuDevice::make({0, 0});
  device.state().peers->share_from = share_from;
  return device;
}

struct WriteIndex {
  int* to;
  TALUS_HD void operator()(int i) const { to[i] = i; }
};
struct ValueOf {
  const int* from;
  TALUS_HD Terms<1> operator()(int i) const { return {{static_cast<double>(from[i])}}; }
};
#endif

TEST_P(GpuStates, share_kernels_and_memory_among_peers) {
#if TALUS_FOR_GPU
  const GpuDevice device = two_parts(1);
  constexpr int count = 9000001;  // 36 MB: a piece for each
  ASSERT_GT(count * static_cast<long>(sizeof(int)), StreamMemory::most_kept);
  Buffer<int, GpuDevice> numbers(device, count);
  numbers.fill_zero();
  for_each(device, count, WriteIndex{numbers.data()});
  std::vector<int> expected(count);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(numbers.download(), expected);
  Buffer<double, GpuDevice> total(device, 1);
  sum_each<1>(device, count, device.state().scratch->sums, ValueOf{numbers.data()}, KeepTotals<1>{total.data()});
  EXPECT_EQ(total.download().front(), 0.5 * count * (count - 1.0));
  numbers.upload(expected);
  EXPECT_EQ(inclusive_sum(device, numbers.data(), numbers.data(), 1000), 999 * 500);
  EXPECT_GT(free_memory(device), 1.5 * free_memory(GpuDevice::make()));
  EXPECT_EQ(device.name(), "2 x " + GpuDevice::make().name());
#endif
}

TEST_P(GpuStates, that_share_a_slide_give_the_bits_of_one) {
#if TALUS_FOR_GPU
  for (const Integrator integrator : {Integrator::explicit_, Integrator::column_implicit, Integrator::newmark}) {
    Domain d = ground(24, 16, 1.0, 1.0, [](double x, double y) { return 0.5 * x + 0.1 * y; });
    fill(d, {10, 16, 5, 11, 0, 2});
    SolveOptions options;
    options.integrator = integrator;
    options.material.youngs_modulus = 1e6;
    options.implicit.step = 0.02;
    options.deterministic = true;
    const Scene scene = make_scene(d, options);
    const auto points_on = [&](const GpuDevice& device) {
      const auto solver = solver::make_solver(scene, options, device);
      run_to(*solver, integrator == Integrator::newmark ? 0.1 : 0.5);
      return solver->state().points;
    };
    const ParticleState alone = points_on(GpuDevice::make());
    for (const std::int64_t share_from : {1, 4096}) expect_same_points(points_on(two_parts(share_from)), alone);
  }
#endif
}
INSTANTIATE_TEST_SUITE_P(places, GpuStates, ::testing::Values(On::gpu), place_name);

}  // namespace
}  // namespace talus::solver::testing
