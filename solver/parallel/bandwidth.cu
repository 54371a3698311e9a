#include "solver/parallel/bandwidth.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "solver/parallel/math.hpp"

namespace talus {
namespace {

struct CopyNumbers {
  const Vec4<double>* from;
  Vec4<double>* to;
  TALUS_HD void operator()(int i) const { to[i] = from[i]; }
};

template <class Device>
double measure_copy(Device place) {
  constexpr std::size_t count = 1 << 23;
  Buffer<Vec4<double>, Device> from(count), to(count);
  from.fill_zero();
  to.fill_zero();
  synchronise(place);
  double best = 0;
  for (int round = 0; round < 5; ++round) {
    const auto begun = std::chrono::steady_clock::now();
    for_each(place, static_cast<int>(count), CopyNumbers{from.data(), to.data()});
    synchronise(place);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    best = std::max(best, 2.0 * count * sizeof(Vec4<double>) / seconds);
  }
  return best;
}

}  // namespace

double copy_bandwidth(CpuDevice place) { return measure_copy(place); }
#if defined(__CUDACC__)
double copy_bandwidth(GpuDevice place) { return measure_copy(place); }
#else
double copy_bandwidth(GpuDevice) { throw std::logic_error("this binary was built without CUDA"); }
#endif

}  // namespace talus
