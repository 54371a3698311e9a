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
  BorrowedMemory memory(GpuDevice::make());
  char* const first = memory.allocate(1000);
  char* const second = memory.allocate(1000);
  EXPECT_NE(first, second);
  memory.deallocate(first, 1000);
  EXPECT_EQ(memory.allocate(900), first) << "it is large enough, and not four times as large";
  memory.deallocate(first, 900);
  char* const small = memory.allocate(100);
  EXPECT_NE(small, first) << "it is more than four times as large";
  memory.deallocate(small, 100);
  memory.deallocate(second, 1000);
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
