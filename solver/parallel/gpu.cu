// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// GPU devices: streams, memory, events, recordings. Without a CUDA compiler this file states that there is no GPU.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "common/error.hpp"
#include "solver/parallel/host_room.hpp"

#if defined(__CUDACC__)
#include "solver/parallel/gpu_state.hpp"

namespace talus {
namespace {

__global__ void probe() {}

std::atomic<bool> gpu_used = false;

/// This function lets the GPU's memory pool keep what is freed for the next allocation of this process, whichever
/// stream asks: cudaMalloc and cudaFree wait for all streams.
void keep_memory(int gpu) {
  cudaMemPool_t pool = nullptr;
  check_cuda(cudaDeviceGetDefaultMemPool(&pool, gpu), "memory pool");
  std::uint64_t all = std::numeric_limits<std::uint64_t>::max();
  check_cuda(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &all), "memory pool");
}

/// The size of memory that is kept by size [bytes]: a quarter of a power of two more at most.
std::size_t rounded_up(std::ptrdiff_t bytes) {
  const auto size = static_cast<std::size_t>(std::max<std::ptrdiff_t>(bytes, 1024)), part = std::bit_floor(size) / 4;
  return (size + part - 1) / part * part;
}

}  // namespace

void check_cuda(cudaError_t code, const char* what) {
  if (code == cudaSuccess) return;
  if (code == cudaErrorMemoryAllocation) {
    throw NumericalError({std::string("GPU memory: ") + what + " failed", "the scene does not fit on this device",
                          "Use precision = \"single\", fewer points_per_cell, a larger spacing_m, or --on cpu"});
  }
  throw std::runtime_error(std::string("CUDA: ") + what + ": " + cudaGetErrorString(code));
}

char* StreamMemory::allocate(std::ptrdiff_t bytes) {
  const bool keeps = bytes <= most_kept;
  const std::size_t size = keeps ? rounded_up(bytes) : static_cast<std::size_t>(bytes);
  const std::lock_guard<std::mutex> one(mutex_);
  if (const auto found = keeps ? kept_.find(size) : kept_.end(); found != kept_.end()) {
    char* const memory = found->second;
    kept_.erase(found);
    return memory;
  }
  char* memory = take(size, keeps);
  if (memory == nullptr) {
    drop_kept();
    memory = take(size, keeps);
  }
  if (memory == nullptr) check_cuda(cudaErrorMemoryAllocation, "an allocation");
  return memory;
}

char* StreamMemory::take(std::size_t bytes, bool keeps) {
  if (peers_ != nullptr && !keeps) return peers_->allocate(bytes);
  void* memory = nullptr;
  const cudaError_t code = cudaMallocAsync(&memory, bytes, stream_);
  if (code == cudaSuccess) return static_cast<char*>(memory);
  (void)cudaGetLastError();
  if (code != cudaErrorMemoryAllocation) check_cuda(code, "cudaMallocAsync");
  return nullptr;
}

void StreamMemory::deallocate(char* memory, std::ptrdiff_t bytes) {
  const std::lock_guard<std::mutex> one(mutex_);
  if (bytes <= most_kept) {
    kept_.emplace(rounded_up(bytes), memory);
  } else if (peers_ != nullptr) {
    peers_->free(memory);
  } else {
    (void)cudaFreeAsync(memory, stream_);
  }
}

void StreamMemory::drop_kept() {
  for (const auto& [bytes, memory] : kept_) (void)cudaFreeAsync(memory, stream_);
  kept_.clear();
}

GpuState::GpuState(const std::vector<int>& gpus) : index(gpus.front()) {
  gpu_used = true;
  check_cuda(cudaSetDevice(index), "cudaSetDevice");
  check_cuda(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "stream");
  keep_memory(index);
  cudaFuncAttributes attributes;  // code made for older devices does not wait
  starts_early = gpus.size() == 1 && cudaFuncGetAttributes(&attributes, probe) == cudaSuccess &&
                 attributes.binaryVersion >= 90 && attributes.ptxVersion >= 90;
  void* host = nullptr;
  if (cudaMallocHost(&host, LockedMemory::size) == cudaSuccess) locked.memory = static_cast<char*>(host);
  (void)cudaGetLastError();
  if (gpus.size() > 1) peers = std::make_unique<Peers>(gpus, stream);
  memory = std::make_unique<StreamMemory>(stream, peers.get());
  // The scratch buffers are part of this state: their handle must not keep it alive.
  const GpuDevice self(std::shared_ptr<GpuState>(std::shared_ptr<void>(), this));
  scratch = std::make_unique<GpuScratch>(self);
}

GpuState::~GpuState() {
  (void)cudaSetDevice(index);
  (void)cudaStreamSynchronize(stream);
  scratch.reset();
  memory.reset();
  peers.reset();
  for (cudaEvent_t event : free_marks) (void)cudaEventDestroy(event);
  if (locked.memory) (void)cudaFreeHost(locked.memory);
  for (const auto& [bytes, room] : host_rooms) (void)cudaFreeHost(room);
  (void)cudaStreamDestroy(stream);
}

void GpuState::select() {
  is_idle = false;
  int selected = -1;
  if (cudaGetDevice(&selected) != cudaSuccess || selected != index) check_cuda(cudaSetDevice(index), "cudaSetDevice");
}

void GpuState::wait(const char* what) {
  if (is_idle) return;
  select();
  check_cuda(cudaStreamSynchronize(stream), what);
  is_idle = true;
  locked.used = LockedMemory::few;
}

GpuDevice GpuDevice::make(int index) { return make(std::vector{index}); }
GpuDevice GpuDevice::make(const std::vector<int>& indices) { return GpuDevice(std::make_shared<GpuState>(indices)); }

int GpuDevice::count() {
  int count = 0;
  if (cudaGetDeviceCount(&count) == cudaSuccess) return count;
  (void)cudaGetLastError();
  return 0;
}

int GpuDevice::index() const { return state_->index; }
std::string GpuDevice::name() const {
  cudaDeviceProp properties;
  check_cuda(cudaGetDeviceProperties(&properties, state_->index), "cudaGetDeviceProperties");
  return (state_->peers ? std::to_string(state_->peers->count()) + " x " : "") + properties.name;
}
CUstream_st* GpuDevice::stream() const { return state_->stream; }
Profile& GpuDevice::profile() const { return state_->profile; }

bool gpu_available() {
  static const bool available = [] {
    if (GpuDevice::count() == 0) return false;
    cudaFuncAttributes attributes;  // fails on a device older than every compiled architecture
    const bool loads = cudaFuncGetAttributes(&attributes, probe) == cudaSuccess;
    (void)cudaGetLastError();
    return loads;
  }();
  return available;
}

bool gpu_was_used() { return gpu_used; }

void synchronise(const GpuDevice& device) { device.state().wait("kernel"); }

namespace detail {

void* allocate(const GpuDevice& device, std::size_t bytes) {
  GpuState& state = device.state();
  if (state.recording) throw std::logic_error("memory that a recording allocates would end with the recording");
  state.select();
  return state.memory->allocate(static_cast<std::ptrdiff_t>(bytes));
}

void free(const GpuDevice& device, void* memory, std::size_t bytes) noexcept {
  (void)cudaSetDevice(device.index());
  device.state().memory->deallocate(static_cast<char*>(memory), static_cast<std::ptrdiff_t>(bytes));
}

void upload(const GpuDevice& device, void* to, const void* host, std::size_t bytes) {
  GpuState& state = device.state();
  if (state.recording) throw std::logic_error("an upload within a recording would be repeated with what it was then");
  state.select();
  LockedMemory& locked = state.locked;
  if (!locked.memory || bytes > LockedMemory::few) {
    check_cuda(cudaMemcpyAsync(to, host, bytes, cudaMemcpyHostToDevice, state.stream), "upload");
    return state.wait("upload");
  }
  if (locked.used + bytes > LockedMemory::size) state.wait("upload");
  char* const between = locked.memory + locked.used;
  std::memcpy(between, host, bytes);
  locked.used += (bytes + 63) / 64 * 64;
  check_cuda(cudaMemcpyAsync(to, between, bytes, cudaMemcpyHostToDevice, state.stream), "upload");
}

void download(const GpuDevice& device, void* host, const void* from, std::size_t bytes) {
  GpuState& state = device.state();
  state.select();
  const bool by_locked = state.locked.memory && bytes <= LockedMemory::few;
  void* const to = by_locked ? state.locked.memory : host;
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, state.stream), "download");
  state.wait("download");
  if (by_locked) std::memcpy(host, to, bytes);
}

void fill_zero(const GpuDevice& device, void* memory, std::size_t bytes) {
  device.state().select();
  check_cuda(cudaMemsetAsync(memory, 0, bytes, device.stream()), "fill");
}

void* lend_host(const GpuDevice& device, std::size_t bytes) {
  GpuState& state = device.state();
  if (const auto free = state.host_rooms.find(bytes); free != state.host_rooms.end()) {
    void* const memory = free->second;
    state.host_rooms.erase(free);
    return memory;
  }
  state.select();
  void* memory = nullptr;
  check_cuda(cudaMallocHost(&memory, bytes), "cudaMallocHost");
  return memory;
}

void give_back_host(const GpuDevice& device, void* memory, std::size_t bytes) noexcept {
  (void)cudaSetDevice(device.index());
  (void)cudaStreamSynchronize(device.stream());
  device.state().host_rooms.emplace(bytes, memory);
}

void gpu_select(const GpuDevice& device) { device.state().select(); }
void gpu_check_launch(const char* where) { check_cuda(cudaGetLastError(), where); }
bool gpu_starts_early(const GpuDevice& device) { return device.state().starts_early; }

int gpu_begin_shares(const GpuDevice& device, std::int64_t threads) {
  GpuState& state = device.state();
  state.select();
  Peers* const peers = state.peers.get();
  if (peers == nullptr || threads < peers->share_from) return 1;
  peers->fork();
  return peers->count();
}
CUstream_st* gpu_share(const GpuDevice& device, int n) { return device.state().peers->select(n); }
void gpu_end_shares(const GpuDevice& device) { device.state().peers->join(); }

void gpu_begin_recording(const GpuDevice& device) {
  GpuState& state = device.state();
  state.select();
  check_cuda(cudaStreamBeginCapture(state.stream, cudaStreamCaptureModeRelaxed), "begin of a recording");
  state.recording = true;
}

void* gpu_end_recording(const GpuDevice& device, void* before) {
  GpuState& state = device.state();
  state.select();
  state.recording = false;
  cudaGraph_t graph = nullptr;
  check_cuda(cudaStreamEndCapture(state.stream, &graph), "end of a recording");
  auto executable = static_cast<cudaGraphExec_t>(before);
  cudaGraphExecUpdateResultInfo info;
  if (executable && cudaGraphExecUpdate(executable, graph, &info) != cudaSuccess) {
    (void)cudaGetLastError();
    check_cuda(cudaGraphExecDestroy(executable), "graph");
    executable = nullptr;
  }
  if (!executable) check_cuda(cudaGraphInstantiate(&executable, graph, 0), "graph");
  check_cuda(cudaGraphDestroy(graph), "graph");
  return executable;
}

void gpu_replay(const GpuDevice& device, void* graph) {
  device.state().select();
  check_cuda(cudaGraphLaunch(static_cast<cudaGraphExec_t>(graph), device.stream()), "graph");
}
void gpu_drop(void* graph) {
  if (graph) (void)cudaGraphExecDestroy(static_cast<cudaGraphExec_t>(graph));
}

void* gpu_mark(const GpuDevice& device) {
  GpuState& state = device.state();
  state.select();
  cudaEvent_t event = nullptr;
  if (state.free_marks.empty()) {
    check_cuda(cudaEventCreate(&event), "event");
  } else {
    event = state.free_marks.back();
    state.free_marks.pop_back();
  }
  check_cuda(
      cudaEventRecordWithFlags(event, state.stream, state.recording ? cudaEventRecordExternal : cudaEventRecordDefault),
      "event");
  return event;
}
double gpu_seconds_between(void* first, void* second) {
  float milliseconds = 0;
  check_cuda(cudaEventElapsedTime(&milliseconds, static_cast<cudaEvent_t>(first), static_cast<cudaEvent_t>(second)),
             "event");
  return 1e-3 * static_cast<double>(milliseconds);
}
void gpu_forget_mark(const GpuDevice& device, void* mark) {
  device.state().free_marks.push_back(static_cast<cudaEvent_t>(mark));
}

}  // namespace detail
}  // namespace talus

#else

namespace talus {
namespace {
[[noreturn]] void absent() { throw std::logic_error("this binary was built without CUDA"); }
}  // namespace

GpuDevice GpuDevice::make(int) { absent(); }
GpuDevice GpuDevice::make(const std::vector<int>&) { absent(); }
int GpuDevice::count() { return 0; }
int GpuDevice::index() const { absent(); }
std::string GpuDevice::name() const { absent(); }
CUstream_st* GpuDevice::stream() const { absent(); }
Profile& GpuDevice::profile() const { absent(); }
bool gpu_available() { return false; }
bool gpu_was_used() { return false; }
void synchronise(const GpuDevice&) {}

namespace detail {
void* allocate(const GpuDevice&, std::size_t) { absent(); }
void free(const GpuDevice&, void*, std::size_t) noexcept {}
void upload(const GpuDevice&, void*, const void*, std::size_t) { absent(); }
void download(const GpuDevice&, void*, const void*, std::size_t) { absent(); }
void fill_zero(const GpuDevice&, void*, std::size_t) { absent(); }
void* lend_host(const GpuDevice&, std::size_t) { absent(); }
void give_back_host(const GpuDevice&, void*, std::size_t) noexcept {}
void gpu_select(const GpuDevice&) { absent(); }
void gpu_check_launch(const char*) {}
bool gpu_starts_early(const GpuDevice&) { return false; }
void gpu_begin_recording(const GpuDevice&) { absent(); }
void* gpu_end_recording(const GpuDevice&, void*) { absent(); }
void gpu_replay(const GpuDevice&, void*) { absent(); }
void gpu_drop(void*) {}
void* gpu_mark(const GpuDevice&) { absent(); }
double gpu_seconds_between(void*, void*) { absent(); }
void gpu_forget_mark(const GpuDevice&, void*) {}
}  // namespace detail
}  // namespace talus

#endif
