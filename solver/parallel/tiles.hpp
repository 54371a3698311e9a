// Scatters by tiles: points that stand side by side in memory mostly share their nodes, so that a GPU can sum what they give before it goes to memory.
#pragma once

#include <new>

#include "solver/parallel/place.hpp"

namespace talus {

/// Runs a scatter over points. The kernel is one for_each_grouped can run, with the parts of its work as members:
///   nodes_each       how many a point has
///   Source           a point as its nodes see it, made from (kernel, point)
///   Sums             what a node receives, zero to begin with
///   counts(p)        whether the point gives anything
///   same_nodes(s, t) whether two sources have the same nodes
///   add(s, n, sums)  adds what node n of the source receives
///   give(s, n, sums) passes the sums on to that node
template <class Kernel>
void scatter_points(OnCpu place, int count, const PointGroups& groups, const Kernel& kernel) {
  for_each_grouped(place, count, groups, kernel);
}

#if defined(__CUDACC__)
namespace detail {

inline constexpr int tile_points = 64;  // of a block: 26 kB of shared memory for P2G in double precision

/// A warp reads 32 points, one a lane, and then takes a lane for every node: sums stay in registers for as long as the next point has the same
/// nodes, and go out by one atomic a node (after Gao et al. 2018).
template <class Kernel>
__global__ void run_tiles(int count, Kernel kernel) {
  using Source = typename Kernel::Source;
  constexpr int warp_size = 32, teams = warp_size / Kernel::nodes_each, each = warp_size / teams;  // teams of lanes, and points of each
  __shared__ alignas(16) unsigned char room[tile_points * sizeof(Source)];
  __shared__ bool counts[tile_points];
  auto* const tile = reinterpret_cast<Source*>(room);
  const int mine = static_cast<int>(threadIdx.x), p = static_cast<int>(blockIdx.x) * tile_points + mine;
  counts[mine] = p < count && kernel.counts(p);
  if (counts[mine]) new (tile + mine) Source(kernel, p);
  __syncwarp();
  const int lane = mine % warp_size, team = lane / Kernel::nodes_each, node = lane % Kernel::nodes_each;
  if (team >= teams) return;
  const int first = mine / warp_size * warp_size + team * each;
  typename Kernel::Sums sums;
  for (int q = first; q < first + each; ++q) {
    if (!counts[q]) continue;
    kernel.add(tile[q], node, sums);
    if (q + 1 < first + each && counts[q + 1] && kernel.same_nodes(tile[q], tile[q + 1])) continue;
    kernel.give(tile[q], node, sums);
    sums = {};
  }
}

}  // namespace detail

template <class Kernel>
void scatter_points(OnGpu, int count, const PointGroups&, const Kernel& kernel) {
  if (count <= 0) return;
  detail::run_tiles<<<(count + detail::tile_points - 1) / detail::tile_points, detail::tile_points>>>(count, kernel);
  detail::gpu_check_launch(__PRETTY_FUNCTION__);
}
#endif

}  // namespace talus
