#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>

#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/sums.hpp"

#if defined(__CUDACC__)
#include <thrust/device_ptr.h>
#include <thrust/execution_policy.h>
#include <thrust/gather.h>
#include <thrust/scan.h>
#include <thrust/scatter.h>
#include <thrust/sequence.h>
#include <thrust/system/cuda/execution_policy.h>
#include <cub/device/device_radix_sort.cuh>

namespace talus {
namespace {

/// What Thrust borrows, kept for the next call: to allocate device memory is to wait for the device.
class Borrowed {
 public:
  using value_type = char;
  char* allocate(std::ptrdiff_t bytes) {
    const auto found = free_.lower_bound(bytes);
    if (found != free_.end() && found->first <= 4 * bytes) {
      char* memory = found->second;
      taken_[memory] = found->first;
      free_.erase(found);
      return memory;
    }
    char* memory = static_cast<char*>(detail::gpu_allocate(static_cast<std::size_t>(bytes)));
    taken_[memory] = bytes;
    return memory;
  }
  void deallocate(char* memory, std::size_t) {
    const auto entry = taken_.find(memory);
    free_.emplace(entry->second, memory);
    taken_.erase(entry);
  }

 private:
  std::multimap<std::ptrdiff_t, char*> free_;
  std::map<char*, std::ptrdiff_t> taken_;
};

Borrowed borrowed;  // until the process ends: the driver takes it back

auto policy() { return thrust::cuda::par_nosync(borrowed); }

struct Products {
  const double *a, *b;
  TALUS_HD Terms<1> operator()(int i) const { return {{a[i] * b[i]}}; }
};

/// The other side that a radix sort writes to by turns; grows with the largest sort.
struct SortSpace {
  Buffer<std::uint64_t, GpuDevice> keys;
  Buffer<int, GpuDevice> order;
  Buffer<char, GpuDevice> rest;
};

SortSpace& sort_space() {
  static auto* const kept = new SortSpace;  // until the process ends, as above
  return *kept;
}

void check_cub(cudaError_t code) {
  if (code != cudaSuccess) throw std::runtime_error(std::string("CUDA: sort: ") + cudaGetErrorString(code));
}

/// What is behind a list's sums is its last value and its last sum.
struct TakeLast {
  const int* values;
  int at;
  int* last;
  TALUS_HD void operator()(int) const { *last = values[at]; }
};
struct AddLast {
  const int* sums;
  int at;
  int* total;
  TALUS_HD void operator()(int) const { *total += sums[at]; }
};

void start_sum(const int* values, int* sums, int count, int* total) {
  for_each(GpuDevice{}, 1, TakeLast{values, count - 1, total});  // before it is written over
  thrust::exclusive_scan(policy(), thrust::device_ptr<const int>(values), thrust::device_ptr<const int>(values) + count,
                         thrust::device_ptr<int>(sums));
  for_each(GpuDevice{}, 1, AddLast{sums, count - 1, total});
}

Buffer<int, GpuDevice>& totals() {
  static auto* const kept = new Buffer<int, GpuDevice>(2);  // until the process ends, as above
  return *kept;
}

}  // namespace

void sort_order(GpuDevice, Buffer<std::uint64_t, GpuDevice>& keys, Buffer<int, GpuDevice>& order, int bits) {
  SortSpace& space = sort_space();
  const std::size_t count = keys.size();
  order.resize(count);
  if (count == 0) return;
  space.keys.resize(count);
  space.order.resize(count);
  const thrust::device_ptr<int> o(order.data());
  thrust::sequence(policy(), o, o + static_cast<std::ptrdiff_t>(count));
  cub::DoubleBuffer<std::uint64_t> k(keys.data(), space.keys.data());
  cub::DoubleBuffer<int> v(order.data(), space.order.data());
  std::size_t bytes = 0;
  check_cub(
      cub::DeviceRadixSort::SortPairs(nullptr, bytes, k, v, static_cast<int>(count), 0, bits, detail::gpu_stream()));
  space.rest.resize(bytes);
  check_cub(cub::DeviceRadixSort::SortPairs(space.rest.data(), bytes, k, v, static_cast<int>(count), 0, bits,
                                            detail::gpu_stream()));
  if (k.Current() != keys.data()) keys.swap(space.keys);
  if (v.Current() != order.data()) order.swap(space.order);
}

std::size_t sort_space_bytes(GpuDevice) {
  return sort_space().keys.bytes() + sort_space().order.bytes() + sort_space().rest.bytes();
}
void drop_sort_space(GpuDevice) { sort_space() = SortSpace{}; }

int exclusive_sum(GpuDevice, const int* values, int* sums, int count) {
  if (count == 0) return 0;
  int total = 0;
  start_sum(values, sums, count, totals().data());
  detail::gpu_download(&total, totals().data(), sizeof total);
  return total;
}

std::array<int, 2> exclusive_sums(GpuDevice, int* first, int* second, int count) {
  std::array<int, 2> both{};
  if (count == 0) return both;
  start_sum(first, first, count, totals().data());
  start_sum(second, second, count, totals().data() + 1);
  detail::gpu_download(both.data(), totals().data(), sizeof both);
  return both;
}

double inner_product(GpuDevice place, const double* a, const double* b, int count) {
  static SumSpace<GpuDevice> space;
  static Buffer<double, GpuDevice> total(1);
  sum_each<1>(place, count, space, Products{a, b}, KeepTotals<1>{total.data()});
  return total.download().front();
}

void gather(GpuDevice, const double* from, const int* order, double* to, int count) {
  const thrust::device_ptr<const int> o(order);
  thrust::gather(policy(), o, o + count, thrust::device_ptr<const double>(from), thrust::device_ptr<double>(to));
}

void scatter(GpuDevice, const double* from, const int* order, double* to, int count) {
  const thrust::device_ptr<const double> f(from);
  thrust::scatter(policy(), f, f + count, thrust::device_ptr<const int>(order), thrust::device_ptr<double>(to));
}

double free_memory(GpuDevice) {
  std::size_t free = 0, total = 0;
  if (cudaMemGetInfo(&free, &total) != cudaSuccess) throw std::runtime_error("CUDA: cudaMemGetInfo failed");
  return static_cast<double>(free);
}

}  // namespace talus

#else

namespace talus {
void sort_order(GpuDevice, Buffer<std::uint64_t, GpuDevice>&, Buffer<int, GpuDevice>&, int) {
  throw std::logic_error("no CUDA");
}
int exclusive_sum(GpuDevice, const int*, int*, int) { throw std::logic_error("no CUDA"); }
std::size_t sort_space_bytes(GpuDevice) { return 0; }
void drop_sort_space(GpuDevice) {}
std::array<int, 2> exclusive_sums(GpuDevice, int*, int*, int) { throw std::logic_error("no CUDA"); }
double inner_product(GpuDevice, const double*, const double*, int) { throw std::logic_error("no CUDA"); }
void gather(GpuDevice, const double*, const int*, double*, int) { throw std::logic_error("no CUDA"); }
void scatter(GpuDevice, const double*, const int*, double*, int) { throw std::logic_error("no CUDA"); }
double free_memory(GpuDevice) { throw std::logic_error("no CUDA"); }
}  // namespace talus

#endif
