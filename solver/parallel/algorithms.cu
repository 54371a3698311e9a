// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "solver/parallel/algorithms.hpp"

namespace talus {
namespace {

struct CopyNumbers {
  const Vec4<double>* from;
  Vec4<double>* to;
  TALUS_HD void operator()(int i) const { to[i] = from[i]; }
};

template <class Device>
double measure_copy(const Device& device) {
  constexpr std::size_t count = 1 << 23;
  Buffer<Vec4<double>, Device> from(device, count), to(device, count);
  from.fill_zero();
  to.fill_zero();
  synchronise(device);
  double best = 0;
  for (int round = 0; round < 5; ++round) {
    const auto begun = std::chrono::steady_clock::now();
    for_each(device, static_cast<int>(count), CopyNumbers{from.data(), to.data()});
    synchronise(device);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    best = std::max(best, 2.0 * count * sizeof(Vec4<double>) / seconds);
  }
  return best;
}

}  // namespace

double copy_bandwidth(const CpuDevice& device) { return measure_copy(device); }

}  // namespace talus

#if defined(__CUDACC__)
#include <thrust/device_ptr.h>
#include <thrust/execution_policy.h>
#include <thrust/gather.h>
#include <thrust/scan.h>
#include <thrust/scatter.h>
#include <thrust/sequence.h>
#include <thrust/system/cuda/execution_policy.h>
#include <cub/device/device_radix_sort.cuh>

#include "solver/parallel/gpu_state.hpp"

namespace talus {

namespace {

/// The policy that sends Thrust's work to the device's stream; it is asked for anew before every call.
auto policy(const GpuDevice& device) {
  GpuState& state = device.state();
  state.select();
  return thrust::cuda::par_nosync(*state.memory).on(state.stream);
}

struct Products {
  const double *a, *b;
  TALUS_HD Terms<1> operator()(int i) const { return {{a[i] * b[i]}}; }
};

}  // namespace

void sort_order(const GpuDevice& device, Buffer<std::uint64_t, GpuDevice>& keys, Buffer<int, GpuDevice>& order,
                int bits) {
  SortSpace& space = device.state().scratch->sort;
  const std::size_t count = keys.size();
  order.resize(count);
  if (count == 0) return;
  space.keys.resize(count);
  space.order.resize(count);
  const thrust::device_ptr<int> o(order.data());
  thrust::sequence(policy(device), o, o + static_cast<std::ptrdiff_t>(count));
  cub::DoubleBuffer<std::uint64_t> k(keys.data(), space.keys.data());
  cub::DoubleBuffer<int> v(order.data(), space.order.data());
  std::size_t bytes = 0;
  const int items = static_cast<int>(count);
  check_cuda(cub::DeviceRadixSort::SortPairs(nullptr, bytes, k, v, items, 0, bits, device.stream()), "sort");
  space.rest.resize(bytes);
  check_cuda(cub::DeviceRadixSort::SortPairs(space.rest.data(), bytes, k, v, items, 0, bits, device.stream()), "sort");
  if (k.Current() != keys.data()) keys.swap(space.keys);
  if (v.Current() != order.data()) order.swap(space.order);
}

std::size_t sort_space_bytes(const GpuDevice& device) {
  const SortSpace& space = device.state().scratch->sort;
  return space.keys.bytes() + space.order.bytes() + space.rest.bytes();
}
void drop_sort_space(const GpuDevice& device) {
  SortSpace& space = device.state().scratch->sort;
  space.keys.drop();
  space.order.drop();
  space.rest.drop();
}

template <class Number>
Number inclusive_sum(const GpuDevice& device, const Number* values, Number* sums, int count) {
  if (count == 0) return 0;
  const thrust::device_ptr<const Number> first(values);
  thrust::inclusive_scan(policy(device), first, first + count, thrust::device_ptr<Number>(sums));
  Number total = 0;
  detail::download(device, &total, sums + count - 1, sizeof total);
  return total;
}
template int inclusive_sum(const GpuDevice&, const int*, int*, int);
template std::uint64_t inclusive_sum(const GpuDevice&, const std::uint64_t*, std::uint64_t*, int);

double inner_product(const GpuDevice& device, const double* a, const double* b, int count) {
  GpuScratch& scratch = *device.state().scratch;
  sum_each<1>(device, count, scratch.sums, Products{a, b}, KeepTotals<1>{scratch.product.data()});
  return scratch.product.download().front();
}

void gather(const GpuDevice& device, const double* from, const int* order, double* to, int count) {
  const thrust::device_ptr<const int> o(order);
  thrust::gather(policy(device), o, o + count, thrust::device_ptr<const double>(from), thrust::device_ptr<double>(to));
}

void scatter(const GpuDevice& device, const double* from, const int* order, double* to, int count) {
  const thrust::device_ptr<const double> f(from);
  thrust::scatter(policy(device), f, f + count, thrust::device_ptr<const int>(order), thrust::device_ptr<double>(to));
}

double free_memory(const GpuDevice& device) {
  device.state().select();
  std::size_t free = 0, total = 0;
  check_cuda(cudaMemGetInfo(&free, &total), "cudaMemGetInfo");
  cudaMemPool_t pool = nullptr;
  check_cuda(cudaDeviceGetDefaultMemPool(&pool, device.index()), "memory pool");
  std::uint64_t reserved = 0, used = 0;
  check_cuda(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrReservedMemCurrent, &reserved), "memory pool");
  check_cuda(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrUsedMemCurrent, &used), "memory pool");
  const Peers* const peers = device.state().peers.get();  // large buffers are shared by all
  return (static_cast<double>(free) + static_cast<double>(reserved - used)) * (peers ? peers->count() : 1);
}

double copy_bandwidth(const GpuDevice& device) { return measure_copy(device); }

}  // namespace talus

#else

namespace talus {
void sort_order(const GpuDevice&, Buffer<std::uint64_t, GpuDevice>&, Buffer<int, GpuDevice>&, int) {
  throw std::logic_error("no CUDA");
}
template <class Number>
Number inclusive_sum(const GpuDevice&, const Number*, Number*, int) {
  throw std::logic_error("no CUDA");
}
template int inclusive_sum(const GpuDevice&, const int*, int*, int);
template std::uint64_t inclusive_sum(const GpuDevice&, const std::uint64_t*, std::uint64_t*, int);
std::size_t sort_space_bytes(const GpuDevice&) { return 0; }
void drop_sort_space(const GpuDevice&) {}
double inner_product(const GpuDevice&, const double*, const double*, int) { throw std::logic_error("no CUDA"); }
void gather(const GpuDevice&, const double*, const int*, double*, int) { throw std::logic_error("no CUDA"); }
void scatter(const GpuDevice&, const double*, const int*, double*, int) { throw std::logic_error("no CUDA"); }
double free_memory(const GpuDevice&) { throw std::logic_error("no CUDA"); }
double copy_bandwidth(const GpuDevice&) { throw std::logic_error("this binary was built without CUDA"); }
}  // namespace talus

#endif
