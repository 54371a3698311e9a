// The two places a kernel runs: CpuDevice (oneTBB) and GpuDevice (CUDA), both in one binary, chosen at run time. A
// kernel is a plain struct of pointers and numbers with operator()(int index) const.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "solver/parallel/atomics.hpp"
#include "solver/parallel/macros.hpp"
#include "solver/parallel/profile.hpp"

struct CUstream_st;  // CUDA's

namespace talus {

struct CpuDevice {
  static constexpr bool is_gpu = false;
};
struct GpuDevice {
  static constexpr bool is_gpu = true;
};

/// True when this binary holds GPU kernels and the machine has a device they run on.
bool gpu_available();
/// Name of the device: "NVIDIA H200"; empty without one.
std::string gpu_name();

namespace detail {
void* cpu_allocate(std::size_t bytes);
void cpu_free(void* memory);
void cpu_parallel(int count, int grain, void (*body)(const void* kernel, int begin, int end), const void* kernel);
void* gpu_allocate(std::size_t bytes);
void gpu_free(void* memory);
void gpu_upload(void* device, const void* host, std::size_t bytes);
void gpu_download(void* host, const void* device, std::size_t bytes);
void gpu_fill_zero(void* device, std::size_t bytes);
void gpu_check_launch(const char* where);
bool gpu_starts_early();    // whether a kernel may come onto the device before the one before it has ended
CUstream_st* gpu_stream();  // where kernels are started: the default stream, or the one that is being recorded
void gpu_begin_recording();
void* gpu_end_recording(void* graph);  // what was recorded; takes the place of an earlier recording, if any
void gpu_replay(void* graph);
void gpu_drop(void* graph);
}  // namespace detail

/// Owned memory in a place. Grows, never shrinks; contents are lost on growth. First as large as asked for: what never
/// grows takes no more.
template <class T, class Device>
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t size) { resize(size); }
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { release(); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }

  /// New size; contents undefined.
  void resize(std::size_t size) {
    if (size > capacity_) {
      const std::size_t wanted = capacity_ == 0 ? size : size + size / 8;
      release();
      if constexpr (Device::is_gpu) {
        data_ = static_cast<T*>(detail::gpu_allocate(wanted * sizeof(T)));
      } else {
        data_ = static_cast<T*>(detail::cpu_allocate(wanted * sizeof(T)));
      }
      capacity_ = wanted;
    }
    size_ = size;
  }
  void upload(const std::vector<T>& values) {
    resize(values.size());
    if (values.empty()) return;
    if constexpr (Device::is_gpu) {
      detail::gpu_upload(data_, values.data(), values.size() * sizeof(T));
    } else {
      std::memcpy(data_, values.data(), values.size() * sizeof(T));
    }
  }
  std::vector<T> download() const {
    std::vector<T> values(size_);
    if (values.empty()) return values;
    if constexpr (Device::is_gpu) {
      detail::gpu_download(values.data(), data_, size_ * sizeof(T));
    } else {
      std::memcpy(values.data(), data_, size_ * sizeof(T));
    }
    return values;
  }
  void fill_zero() {
    if (size_ == 0) return;
    if constexpr (Device::is_gpu) {
      detail::gpu_fill_zero(data_, size_ * sizeof(T));
    } else {
      std::memset(static_cast<void*>(data_), 0, size_ * sizeof(T));
    }
  }
  void swap(Buffer& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

 private:
  void release() {
    if (!data_) return;
    if constexpr (Device::is_gpu) {
      detail::gpu_free(data_);
    } else {
      detail::cpu_free(data_);
    }
    data_ = nullptr;
    capacity_ = 0;
  }
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

/// Upload of values kept in double on the host.
template <class Real, class Device>
void upload_as(Buffer<Real, Device>& to, const std::vector<double>& from) {
  to.upload(std::vector<Real>(from.begin(), from.end()));
}

/// Runs kernel(i) for i in [0, count), in any order.
template <class Kernel>
void for_each(CpuDevice, int count, const Kernel& kernel) {
  const KernelTime<CpuDevice> time(kernel, count);
  detail::cpu_parallel(
      count, 256,
      [](const void* k, int begin, int end) {
        const Kernel local = *static_cast<const Kernel*>(k);
        for (int i = begin; i < end; ++i) local(i);
      },
      &kernel);
}

/// Ranges of points, one per occupied column block, in four colours: blocks of one colour share no grid node.
struct PointGroups {
  using Range = std::pair<int, int>;  // [begin, end) into the points
  std::vector<Range> ranges[4];
  bool in_order = false;  // a GPU goes by them too, so that sums are the same on every run
  Buffer<Range, GpuDevice> on_gpu[4];
  void upload() {
    for (int c = 0; in_order && c < 4; ++c) on_gpu[c].upload(ranges[c]);
  }
};

/// Runs kernel(p) over all points such that scatter_add never meets itself. CPU: colour by colour, each block in order,
/// so sums are the same on every run. GPU: all at once, with atomics; with groups.in_order as the CPU, a thread for
/// every block.
template <class Kernel>
void for_each_grouped(CpuDevice, int count, const PointGroups& groups, const Kernel& kernel) {
  const KernelTime<CpuDevice> time(kernel, count);
  for (const auto& ranges : groups.ranges) {
    struct Body {
      const Kernel* kernel;
      const std::pair<int, int>* ranges;
    } body{&kernel, ranges.data()};
    detail::cpu_parallel(
        static_cast<int>(ranges.size()), 1,
        [](const void* b, int begin, int end) {
          const Body* data = static_cast<const Body*>(b);
          const Kernel local = *data->kernel;
          for (int r = begin; r < end; ++r) {
            for (int p = data->ranges[r].first; p < data->ranges[r].second; ++p) local(p);
          }
        },
        &body);
  }
}

inline void synchronise(CpuDevice) {}
inline void synchronise(GpuDevice) { detail::gpu_synchronise(); }

/// From so many points on every multiprocessor has more to do than it can hold: what counts then is how much gets
/// through, not how soon.
inline constexpr int points_that_keep_a_gpu_busy = 65536;

#if defined(__CUDACC__)
namespace detail {
/// Every kernel's first words. From compute capability 9.0 on a kernel comes onto the device while the one before it is
/// ending (programmatic dependent launch), and waits here until that has written all it had to; its own successor may
/// come then.
__device__ inline void begin_kernel() {
#if __CUDA_ARCH__ >= 900
  asm volatile("griddepcontrol.wait;" ::: "memory");
  asm volatile("griddepcontrol.launch_dependents;");
#endif
}

/// Starts a kernel that opens with begin_kernel().
template <class... Parameters>
void gpu_launch(const char* where, void (*kernel)(Parameters...), int blocks, int threads,
                const std::type_identity_t<Parameters>&... arguments) {
  cudaLaunchAttribute early{};
  early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  early.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t config{};
  config.gridDim = dim3(static_cast<unsigned>(blocks));
  config.blockDim = dim3(static_cast<unsigned>(threads));
  config.stream = gpu_stream();
  config.attrs = &early;
  constexpr int small = 200000;  // threads; with more, those that wait are in the way
  config.numAttrs = gpu_starts_early() && blocks * static_cast<long>(threads) < small ? 1 : 0;
  static_cast<void>(cudaLaunchKernelEx(&config, kernel, arguments...));  // gpu_check_launch tells
  gpu_check_launch(where);
}

/// Threads of a block: few where there is little to do, so that every multiprocessor gets some of it.
inline int threads_for(int count) { return count < 65536 ? 32 : 128; }

template <class Kernel>
__global__ void run_kernel(int count, Kernel kernel) {
  begin_kernel();
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) kernel(i);
}

/// The same in as many registers as let this number of blocks of 128 threads share a multiprocessor.
template <int blocks, class Kernel>
__global__ __launch_bounds__(128, blocks) void run_dense(int count, Kernel kernel) {
  begin_kernel();
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < count) kernel(i);
}
}  // namespace detail

template <class Kernel>
void for_each(GpuDevice, int count, const Kernel& kernel) {
  if (count <= 0) return;
  const KernelTime<GpuDevice> time(kernel, count);
  if constexpr (requires { Kernel::dense; }) {
    if (Kernel::dense > 0 && count >= points_that_keep_a_gpu_busy) {
      return detail::gpu_launch(__PRETTY_FUNCTION__, detail::run_dense<Kernel::dense, Kernel>, (count + 127) / 128, 128,
                                count, kernel);
    }
  }
  const int threads = detail::threads_for(count);
  detail::gpu_launch(__PRETTY_FUNCTION__, detail::run_kernel<Kernel>, (count + threads - 1) / threads, threads, count,
                     kernel);
}

/// One thread: the points of a block, one after the other.
template <class Kernel>
struct InOrder {
  using Named = Kernel;
  Kernel kernel;
  const PointGroups::Range* ranges;
  TALUS_HD void operator()(int r) const {
    const int begin = ranges[r].first, end = ranges[r].second;
    for (int p = begin; p < end; ++p) kernel(p);
  }
};

template <class Kernel>
void for_each_grouped(GpuDevice place, int count, const PointGroups& groups, const Kernel& kernel) {
  if (!groups.in_order) return for_each(place, count, kernel);
  for (const auto& ranges : groups.on_gpu)
    for_each(place, static_cast<int>(ranges.size()), InOrder<Kernel>{kernel, ranges.data()});
}
#endif

}  // namespace talus
