#include <cstddef>
#include <map>
#include <stdexcept>

#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/sums.hpp"

#if defined(__CUDACC__)
#include <thrust/device_ptr.h>
#include <thrust/execution_policy.h>
#include <thrust/gather.h>
#include <thrust/scan.h>
#include <thrust/scatter.h>
#include <thrust/sequence.h>
#include <thrust/sort.h>
#include <thrust/system/cuda/execution_policy.h>

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

}  // namespace

void sort_order(OnGpu, Buffer<std::uint64_t, OnGpu>& keys, Buffer<int, OnGpu>& order) {
  order.resize(keys.size());
  const thrust::device_ptr<std::uint64_t> k(keys.data());
  const thrust::device_ptr<int> o(order.data());
  thrust::sequence(policy(), o, o + static_cast<std::ptrdiff_t>(order.size()));
  thrust::stable_sort_by_key(policy(), k, k + static_cast<std::ptrdiff_t>(keys.size()), o);
}

int exclusive_sum(OnGpu, const int* values, int* sums, int count) {
  if (count == 0) return 0;
  int last_value = 0, last_sum = 0;
  detail::gpu_download(&last_value, values + count - 1, sizeof(int));
  thrust::exclusive_scan(policy(), thrust::device_ptr<const int>(values),
                         thrust::device_ptr<const int>(values) + count, thrust::device_ptr<int>(sums));
  detail::gpu_download(&last_sum, sums + count - 1, sizeof(int));
  return last_value + last_sum;
}

double inner_product(OnGpu place, const double* a, const double* b, int count) {
  static SumSpace<OnGpu> space;
  static Buffer<double, OnGpu> total(1);
  sum_each<1>(place, count, space, Products{a, b}, KeepTotals<1>{total.data()});
  return total.download().front();
}

void gather(OnGpu, const double* from, const int* order, double* to, int count) {
  const thrust::device_ptr<const int> o(order);
  thrust::gather(policy(), o, o + count, thrust::device_ptr<const double>(from), thrust::device_ptr<double>(to));
}

void scatter(OnGpu, const double* from, const int* order, double* to, int count) {
  const thrust::device_ptr<const double> f(from);
  thrust::scatter(policy(), f, f + count, thrust::device_ptr<const int>(order), thrust::device_ptr<double>(to));
}

double free_memory(OnGpu) {
  std::size_t free = 0, total = 0;
  if (cudaMemGetInfo(&free, &total) != cudaSuccess) throw std::runtime_error("CUDA: cudaMemGetInfo failed");
  return static_cast<double>(free);
}

}  // namespace talus

#else

namespace talus {
void sort_order(OnGpu, Buffer<std::uint64_t, OnGpu>&, Buffer<int, OnGpu>&) { throw std::logic_error("no CUDA"); }
int exclusive_sum(OnGpu, const int*, int*, int) { throw std::logic_error("no CUDA"); }
double inner_product(OnGpu, const double*, const double*, int) { throw std::logic_error("no CUDA"); }
void gather(OnGpu, const double*, const int*, double*, int) { throw std::logic_error("no CUDA"); }
void scatter(OnGpu, const double*, const int*, double*, int) { throw std::logic_error("no CUDA"); }
double free_memory(OnGpu) { throw std::logic_error("no CUDA"); }
}  // namespace talus

#endif
