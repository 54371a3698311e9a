// Device memory and error handling. Without a CUDA compiler this file says that there is no GPU.
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "solver/parallel/device.hpp"

#if defined(__CUDACC__)
#include <cuda_runtime.h>

namespace talus {
namespace {

void check(cudaError_t code, const char* what) {
  if (code == cudaSuccess) return;
  if (code == cudaErrorMemoryAllocation) {
    throw NumericalError({std::string("GPU memory: ") + what + " failed", "the scene does not fit on this device",
                          "Use precision = \"single\", fewer points_per_cell, a larger spacing_m, or --on cpu"});
  }
  throw std::runtime_error(std::string("CUDA: ") + what + ": " + cudaGetErrorString(code));
}

__global__ void probe() {}

cudaStream_t recorded = nullptr;  // made with the first recording
bool recording = false;

}  // namespace

bool gpu_available() {
  static const bool available = [] {
    int count = 0;
    if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0) {
      (void)cudaGetLastError();
      return false;
    }
    cudaFuncAttributes attributes;  // fails on a device older than every compiled architecture
    const bool loads = cudaFuncGetAttributes(&attributes, probe) == cudaSuccess;
    (void)cudaGetLastError();
    return loads;
  }();
  return available;
}

std::string gpu_name() {
  cudaDeviceProp properties;
  if (!gpu_available() || cudaGetDeviceProperties(&properties, 0) != cudaSuccess) return {};
  return properties.name;
}

namespace detail {

void* gpu_allocate(std::size_t bytes) {
  void* memory = nullptr;
  check(cudaMalloc(&memory, bytes), "cudaMalloc");
  return memory;
}
void gpu_free(void* memory) { (void)cudaFree(memory); }
void gpu_upload(void* device, const void* host, std::size_t bytes) {
  check(cudaMemcpy(device, host, bytes, cudaMemcpyHostToDevice), "upload");
}
void gpu_download(void* host, const void* device, std::size_t bytes) {
  constexpr std::size_t few = 4096;
  static void* const locked = [] {
    void* memory = nullptr;
    return cudaMallocHost(&memory, few) == cudaSuccess ? memory : nullptr;
  }();
  if (locked && bytes <= few) {  // numbers the host waits for: they come sooner by memory that stays where it is
    check(cudaMemcpyAsync(locked, device, bytes, cudaMemcpyDeviceToHost, nullptr), "download");
    check(cudaStreamSynchronize(nullptr), "download");
    std::memcpy(host, locked, bytes);
    return;
  }
  check(cudaMemcpy(host, device, bytes, cudaMemcpyDeviceToHost), "download");
}
void gpu_fill_zero(void* device, std::size_t bytes) { check(cudaMemsetAsync(device, 0, bytes, gpu_stream()), "fill"); }
void gpu_synchronise() { check(cudaDeviceSynchronize(), "kernel"); }
void gpu_check_launch(const char* where) { check(cudaGetLastError(), where); }

bool gpu_starts_early() {
  static const bool early = [] {
    cudaFuncAttributes attributes;  // code made for older devices does not wait
    return cudaFuncGetAttributes(&attributes, probe) == cudaSuccess && attributes.binaryVersion >= 90 &&
           attributes.ptxVersion >= 90;
  }();
  return early;
}

cudaStream_t gpu_stream() { return recording ? recorded : nullptr; }

void gpu_begin_recording() {
  if (!recorded) check(cudaStreamCreateWithFlags(&recorded, cudaStreamNonBlocking), "stream");
  check(cudaStreamBeginCapture(recorded, cudaStreamCaptureModeRelaxed), "begin of a recording");
  recording = true;
}

void* gpu_end_recording(void* before) {
  recording = false;
  cudaGraph_t graph = nullptr;
  check(cudaStreamEndCapture(recorded, &graph), "end of a recording");
  auto executable = static_cast<cudaGraphExec_t>(before);
  cudaGraphExecUpdateResultInfo info;
  if (executable && cudaGraphExecUpdate(executable, graph, &info) != cudaSuccess) {
    (void)cudaGetLastError();
    check(cudaGraphExecDestroy(executable), "graph");
    executable = nullptr;
  }
  if (!executable) check(cudaGraphInstantiate(&executable, graph, 0), "graph");
  check(cudaGraphDestroy(graph), "graph");
  return executable;
}

namespace {
std::vector<cudaEvent_t> free_marks;
}
void* gpu_mark() {
  cudaEvent_t event = nullptr;
  if (free_marks.empty()) {
    check(cudaEventCreate(&event), "event");
  } else {
    event = free_marks.back();
    free_marks.pop_back();
  }
  check(cudaEventRecordWithFlags(event, gpu_stream(), recording ? cudaEventRecordExternal : cudaEventRecordDefault),
        "event");
  return event;
}
double gpu_seconds_between(void* first, void* second) {
  float milliseconds = 0;
  check(cudaEventElapsedTime(&milliseconds, static_cast<cudaEvent_t>(first), static_cast<cudaEvent_t>(second)),
        "event");
  return 1e-3 * static_cast<double>(milliseconds);
}
void gpu_forget_mark(void* mark) { free_marks.push_back(static_cast<cudaEvent_t>(mark)); }

void gpu_replay(void* graph) { check(cudaGraphLaunch(static_cast<cudaGraphExec_t>(graph), nullptr), "graph"); }
void gpu_drop(void* graph) {
  if (graph) (void)cudaGraphExecDestroy(static_cast<cudaGraphExec_t>(graph));
}

}  // namespace detail
}  // namespace talus

#else

namespace talus {

bool gpu_available() { return false; }
std::string gpu_name() { return {}; }

namespace detail {
namespace {
[[noreturn]] void absent() { throw std::logic_error("this binary was built without CUDA"); }
}  // namespace
void* gpu_allocate(std::size_t) { absent(); }
void gpu_free(void*) {}
void gpu_upload(void*, const void*, std::size_t) { absent(); }
void gpu_download(void*, const void*, std::size_t) { absent(); }
void gpu_fill_zero(void*, std::size_t) { absent(); }
void gpu_synchronise() {}
void gpu_check_launch(const char*) {}
bool gpu_starts_early() { return false; }
CUstream_st* gpu_stream() { absent(); }
void gpu_begin_recording() { absent(); }
void* gpu_end_recording(void*) { absent(); }
void* gpu_mark() { absent(); }
double gpu_seconds_between(void*, void*) { absent(); }
void gpu_forget_mark(void*) {}
void gpu_replay(void*) { absent(); }
void gpu_drop(void*) {}
}  // namespace detail
}  // namespace talus

#endif
