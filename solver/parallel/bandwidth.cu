// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/bandwidth.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/math.hpp"

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
#if defined(__CUDACC__)
double copy_bandwidth(const GpuDevice& device) { return measure_copy(device); }
#else
double copy_bandwidth(const GpuDevice&) { throw std::logic_error("this binary was built without CUDA"); }
#endif

}  // namespace talus
