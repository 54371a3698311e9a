// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a GPU's state keeps for the next call; there is none where the program was built without CUDA.
#include "solver/parallel/macros.hpp"
#if TALUS_FOR_GPU
#include "solver/parallel/gpu_state.hpp"
#endif
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
INSTANTIATE_TEST_SUITE_P(places, GpuStates, ::testing::Values(On::gpu), place_name);

}  // namespace
}  // namespace talus::solver::testing
