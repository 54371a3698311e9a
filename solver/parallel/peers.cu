// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/macros.hpp"
#if TALUS_FOR_GPU
#include <cuda.h>
#include <dlfcn.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "common/error.hpp"
#include "solver/parallel/gpu_state.hpp"
#include "solver/parallel/peers.hpp"

namespace talus {
namespace {

/// The driver's functions for memory of several GPUs at one address. The program links the runtime alone, since it has
/// to start on machines without a driver.
struct Driver {
  decltype(&cuMemGetAllocationGranularity) granularity;
  decltype(&cuMemAddressReserve) reserve;
  decltype(&cuMemAddressFree) give_back;
  decltype(&cuMemCreate) create;
  decltype(&cuMemRelease) release;
  decltype(&cuMemMap) map;
  decltype(&cuMemUnmap) unmap;
  decltype(&cuMemSetAccess) set_access;
};

const Driver& driver() {
  static const Driver found = [] {
    void* const library = dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL);  // stays open as long as the program runs
    const auto load = [library](auto& function, const char* name) {
      if (library != nullptr) function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(library, name));
      if (library == nullptr || function == nullptr)
        throw std::runtime_error(std::string("the driver of the GPUs has no ") + name);
    };
    Driver d{};
    load(d.granularity, "cuMemGetAllocationGranularity");
    load(d.reserve, "cuMemAddressReserve");
    load(d.give_back, "cuMemAddressFree");
    load(d.create, "cuMemCreate");
    load(d.release, "cuMemRelease");
    load(d.map, "cuMemMap");
    load(d.unmap, "cuMemUnmap");
    load(d.set_access, "cuMemSetAccess");
    return d;
  }();
  return found;
}

/// Throws std::runtime_error where the driver's call `what` failed.
void check_driver(CUresult code, const char* what) {
  if (code != CUDA_SUCCESS)
    throw std::runtime_error(std::string("CUDA driver: ") + what + ": error " + std::to_string(static_cast<int>(code)));
}

/// Refuses two GPUs that cannot read one another's memory.
void need_access(int from, int to) {
  int can = from == to ? 1 : 0;
  if (can == 0) check_cuda(cudaDeviceCanAccessPeer(&can, from, to), "cudaDeviceCanAccessPeer");
  if (can == 0)
    throw RecipeError({"--on gpus",
                       "GPU " + std::to_string(from) + " cannot read the memory of GPU " + std::to_string(to),
                       "Use --on gpu, or name GPUs of one switch in CUDA_VISIBLE_DEVICES"});
}

/// Lets `to` read and write what the pool of `from` holds.
void share_pool(int from, int to) {
  if (from == to) return;
  cudaMemPool_t pool = nullptr;
  check_cuda(cudaDeviceGetDefaultMemPool(&pool, from), "memory pool");
  cudaMemAccessDesc access{};
  access.location.type = cudaMemLocationTypeDevice;
  access.location.id = to;
  access.flags = cudaMemAccessFlagsProtReadWrite;
  check_cuda(cudaMemPoolSetAccess(pool, &access, 1), "memory pool");
}

CUmemAllocationProp memory_of(int gpu) {
  CUmemAllocationProp kind{};
  kind.type = CU_MEM_ALLOCATION_TYPE_PINNED;
  kind.location.type = CU_MEM_LOCATION_TYPE_DEVICE;
  kind.location.id = gpu;
  return kind;
}

}  // namespace

Peers::Peers(const std::vector<int>& gpus, cudaStream_t first)
    : share_from(static_cast<std::int64_t>(points_that_keep_a_gpu_busy) * static_cast<std::int64_t>(gpus.size())) {
  for (const int from : gpus) {
    for (const int to : gpus) need_access(from, to);
  }
  for (const int gpu : gpus) {
    check_cuda(cudaSetDevice(gpu), "cudaSetDevice");
    Part part{gpu, first, nullptr};
    if (!parts_.empty()) check_cuda(cudaStreamCreateWithFlags(&part.stream, cudaStreamNonBlocking), "stream");
    check_cuda(cudaEventCreateWithFlags(&part.done, cudaEventDisableTiming), "event");
    parts_.push_back(part);
    share_pool(gpus.front(), gpu);
  }
  check_cuda(cudaSetDevice(gpus.front()), "cudaSetDevice");
}

Peers::~Peers() {
  for (const Part& part : parts_) {
    (void)cudaEventDestroy(part.done);
    if (&part != &parts_.front()) (void)cudaStreamDestroy(part.stream);
  }
}

void Peers::fork() {
  const Part& first = parts_.front();
  check_cuda(cudaEventRecord(first.done, first.stream), "event");
  for (const Part& part : parts_) {
    if (&part != &first) check_cuda(cudaStreamWaitEvent(part.stream, first.done, 0), "wait for an event");
  }
}

cudaStream_t Peers::select(int n) const {
  const Part& part = parts_[static_cast<std::size_t>(n)];
  check_cuda(cudaSetDevice(part.gpu), "cudaSetDevice");
  return part.stream;
}

void Peers::join() {
  const Part& first = parts_.front();
  for (const Part& part : parts_) {
    if (&part == &first) continue;
    check_cuda(cudaEventRecord(part.done, part.stream), "event");
    check_cuda(cudaStreamWaitEvent(first.stream, part.done, 0), "wait for an event");
  }
  check_cuda(cudaSetDevice(first.gpu), "cudaSetDevice");
}

char* Peers::allocate(std::size_t bytes) {
  const Driver& d = driver();
  std::size_t unit = 0;
  const CUmemAllocationProp kind = memory_of(parts_.front().gpu);
  check_driver(d.granularity(&unit, &kind, CU_MEM_ALLOC_GRANULARITY_RECOMMENDED), "granularity");
  const std::size_t piece = (bytes / parts_.size() + unit) / unit * unit, whole = piece * parts_.size();
  CUdeviceptr begin = 0;
  check_driver(d.reserve(&begin, whole, 0, 0, 0), "cuMemAddressReserve");
  std::vector<CUmemAccessDesc> access;
  CUresult made = CUDA_SUCCESS;
  std::size_t mapped = 0;
  for (const Part& part : parts_) {
    const CUmemAllocationProp of_part = memory_of(part.gpu);
    CUmemGenericAllocationHandle handle = 0;
    made = d.create(&handle, piece, &of_part, 0);
    if (made != CUDA_SUCCESS) break;
    made = d.map(begin + mapped, piece, 0, handle, 0);
    (void)d.release(handle);  // the mapping holds it
    if (made != CUDA_SUCCESS) break;
    mapped += piece;
    access.push_back({of_part.location, CU_MEM_ACCESS_FLAGS_PROT_READWRITE});
  }
  if (made == CUDA_SUCCESS) made = d.set_access(begin, whole, access.data(), access.size());
  auto* const memory = reinterpret_cast<char*>(begin);
  if (made == CUDA_SUCCESS) {
    sizes_.emplace(memory, whole);
    return memory;
  }
  if (mapped > 0) (void)d.unmap(begin, mapped);
  (void)d.give_back(begin, whole);
  if (made == CUDA_ERROR_OUT_OF_MEMORY) return nullptr;
  check_driver(made, "memory of several GPUs");
  return nullptr;
}

void Peers::free(char* memory) {
  const auto found = sizes_.find(memory);
  (void)cudaStreamSynchronize(parts_.front().stream);
  (void)driver().unmap(reinterpret_cast<CUdeviceptr>(memory), found->second);
  (void)driver().give_back(reinterpret_cast<CUdeviceptr>(memory), found->second);
  sizes_.erase(found);
}

}  // namespace talus
#endif
