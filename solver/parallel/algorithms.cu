#include <stdexcept>

#include "solver/parallel/algorithms.hpp"

#if defined(__CUDACC__)
#include <thrust/device_ptr.h>
#include <thrust/execution_policy.h>
#include <thrust/gather.h>
#include <thrust/inner_product.h>
#include <thrust/reduce.h>
#include <thrust/scan.h>
#include <thrust/scatter.h>
#include <thrust/sequence.h>
#include <thrust/sort.h>

namespace talus {

void sort_order(OnGpu, Buffer<std::uint64_t, OnGpu>& keys, Buffer<int, OnGpu>& order) {
  order.resize(keys.size());
  const thrust::device_ptr<std::uint64_t> k(keys.data());
  const thrust::device_ptr<int> o(order.data());
  thrust::sequence(thrust::device, o, o + static_cast<std::ptrdiff_t>(order.size()));
  thrust::stable_sort_by_key(thrust::device, k, k + static_cast<std::ptrdiff_t>(keys.size()), o);
}

int exclusive_sum(OnGpu, const int* values, int* sums, int count) {
  if (count == 0) return 0;
  int last_value = 0, last_sum = 0;
  detail::gpu_download(&last_value, values + count - 1, sizeof(int));
  thrust::exclusive_scan(thrust::device, thrust::device_ptr<const int>(values),
                         thrust::device_ptr<const int>(values) + count, thrust::device_ptr<int>(sums));
  detail::gpu_download(&last_sum, sums + count - 1, sizeof(int));
  return last_value + last_sum;
}

double sum(OnGpu, const double* values, int count) {
  const thrust::device_ptr<const double> v(values);
  return thrust::reduce(thrust::device, v, v + count, 0.0);
}

double inner_product(OnGpu, const double* a, const double* b, int count) {
  const thrust::device_ptr<const double> x(a), y(b);
  return thrust::inner_product(thrust::device, x, x + count, y, 0.0);
}

void gather(OnGpu, const double* from, const int* order, double* to, int count) {
  const thrust::device_ptr<const int> o(order);
  thrust::gather(thrust::device, o, o + count, thrust::device_ptr<const double>(from), thrust::device_ptr<double>(to));
}

void scatter(OnGpu, const double* from, const int* order, double* to, int count) {
  const thrust::device_ptr<const double> f(from);
  thrust::scatter(thrust::device, f, f + count, thrust::device_ptr<const int>(order), thrust::device_ptr<double>(to));
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
double sum(OnGpu, const double*, int) { throw std::logic_error("no CUDA"); }
void gather(OnGpu, const double*, const int*, double*, int) { throw std::logic_error("no CUDA"); }
void scatter(OnGpu, const double*, const int*, double*, int) { throw std::logic_error("no CUDA"); }
double free_memory(OnGpu) { throw std::logic_error("no CUDA"); }
}  // namespace talus

#endif
