// Scatters by tiles: points that stand side by side in memory mostly share their nodes, so that a GPU can sum what they give before it goes to memory.
#pragma once

#include <bit>
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
///   give_to(place, sums)  passes them on to a stored node
/// and, for the lanes of a warp to pass on together what lies together in memory:
///   Number, parts    what sums are made of, and of how many
///   columns_each     columns of nodes that a source has; node n stands in column n % columns_each
///   column_of(s, q)  where layer 0 of column q is stored, or would be
///   node_in(column, s, n)  where node n of the source is stored, from that of its column
///   gives(s, n)      false where node n is none of its own: several n of a source may be stored in one place, but only one of them gives
///   store(sums, to)  puts the parts side by side
///   part(node, q)    where part q of a stored node is
///   has(q)           whether there is such a part; may be left out where all are
template <class Kernel>
void scatter_points(OnCpu place, int count, const PointGroups& groups, const Kernel& kernel) {
  for_each_grouped(place, count, groups, kernel);
}

#if defined(__CUDACC__)
namespace detail {

inline constexpr int warp_size = 32, tile_warps = 2;

template <class Kernel>
__device__ bool has_part(const Kernel& kernel, int q) {
  if constexpr (requires { kernel.has(q); }) {
    return kernel.has(q);
  } else {
    return true;
  }
}

/// What the lanes of a team found goes to memory. An atomic of 8 bytes takes as long as the 32 around it: neighbouring lanes add neighbouring parts of one node, not the same part of
/// many nodes.
template <class Kernel>
__device__ void give_together(const Kernel& kernel, int place, int node, unsigned team, const typename Kernel::Sums& sums, typename Kernel::Number* values, int* places) {
  constexpr int parts = Kernel::parts, apart = static_cast<int>(std::bit_ceil(static_cast<unsigned>(parts)));
  kernel.store(sums, values + node * parts);
  places[node] = place;
  __syncwarp(team);
  for (int t = node; t < Kernel::nodes_each * apart; t += Kernel::nodes_each) {
    const int n = t / apart, q = t % apart;
    if (q < parts && has_part(kernel, q)) atomicAdd(kernel.part(places[n], q), values[n * parts + q]);
  }
  __syncwarp(team);
}

/// A warp reads `each` points, one a lane, and then takes a lane for every node: sums stay in registers for as long as the next point has the same
/// nodes, and go out by one atomic a node (after Gao et al. 2018). With 32 points a block takes 26 kB of shared memory for P2G in double precision.
template <int each, class Kernel>
__global__ void run_tiles(int count, Kernel kernel) {
  using Source = typename Kernel::Source;
  constexpr int teams = warp_size / Kernel::nodes_each, share = each / teams;  // teams of lanes, and points of each
  __shared__ alignas(16) unsigned char room[tile_warps * each * sizeof(Source)];
  __shared__ bool counts[tile_warps * each];
  __shared__ int columns[tile_warps * each][Kernel::columns_each];
  auto* const tile = reinterpret_cast<Source*>(room);
  const int lane = static_cast<int>(threadIdx.x) % warp_size, warp = static_cast<int>(threadIdx.x) / warp_size;
  bool any = false;
  if (lane < each) {
    const int mine = warp * each + lane, p = static_cast<int>(blockIdx.x) * tile_warps * each + mine;
    counts[mine] = any = p < count && kernel.counts(p);
    if (any) {
      const Source& source = *new (tile + mine) Source(kernel, p);
      for (int q = 0; q < Kernel::columns_each; ++q) columns[mine][q] = kernel.column_of(source, q);
    }
  }
  if (!__any_sync(0xffffffffu, any)) return;
  const int team = lane / Kernel::nodes_each, node = lane % Kernel::nodes_each;
  if (team >= teams) return;
  constexpr bool together = sizeof(typename Kernel::Number) == 8;  // single precision has an atomic of 16 bytes
  __shared__ typename Kernel::Number values[together ? tile_warps * teams * Kernel::nodes_each * Kernel::parts : 1];
  __shared__ int places[together ? tile_warps * teams * Kernel::nodes_each : 1];
  const int mine = (warp * teams + team) * Kernel::nodes_each;
  const unsigned lanes = ((1u << Kernel::nodes_each) - 1u) << (team * Kernel::nodes_each);
  const int first = warp * each + team * share;
  typename Kernel::Sums sums;
  for (int q = first; q < first + share; ++q) {
    if (!counts[q]) continue;
    kernel.add(tile[q], node, sums);
    if (q + 1 < first + share && counts[q + 1] && kernel.same_nodes(tile[q], tile[q + 1])) continue;
    const int place = kernel.node_in(columns[q][node % Kernel::columns_each], tile[q], node);
    if constexpr (together) {
      give_together(kernel, place, node, lanes, sums, values + mine * Kernel::parts, places + mine);
    } else {
      kernel.give_to(place, sums);
    }
    sums = {};
  }
}

template <int each, class Kernel>
void start_tiles(int count, const Kernel& kernel) {
  constexpr int points = tile_warps * each;
  run_tiles<each><<<(count + points - 1) / points, tile_warps * warp_size, 0, gpu_stream()>>>(count, kernel);
  gpu_check_launch(__PRETTY_FUNCTION__);
}

/// A warp takes the points of a block of columns one after the other, a lane for every node.
template <class Kernel>
__global__ void run_tiles_in_order(const PointGroups::Range* ranges, Kernel kernel) {
  using Source = typename Kernel::Source;
  __shared__ alignas(16) unsigned char room[warp_size * sizeof(Source)];
  __shared__ bool counts[warp_size];
  auto* const tile = reinterpret_cast<Source*>(room);
  const int begin = ranges[blockIdx.x].first, end = ranges[blockIdx.x].second, lane = static_cast<int>(threadIdx.x);
  for (int first = begin; first < end; first += warp_size) {
    __syncwarp();
    const int p = first + lane;
    counts[lane] = p < end && kernel.counts(p);
    if (counts[lane]) new (tile + lane) Source(kernel, p);
    __syncwarp();
    for (int q = 0; q < warp_size; ++q) {
      if (!counts[q]) continue;
      if (lane < Kernel::nodes_each && kernel.gives(tile[q], lane)) {
        typename Kernel::Sums sums;
        kernel.add(tile[q], lane, sums);
        typename Kernel::Number parts[Kernel::parts];
        kernel.store(sums, parts);
        const int node = kernel.node_in(kernel.column_of(tile[q], lane % Kernel::columns_each), tile[q], lane);
        for (int q = 0; q < Kernel::parts; ++q) {
          if (has_part(kernel, q)) *kernel.part(node, q) += parts[q];
        }
      }
      __syncwarp();
    }
  }
}

}  // namespace detail

template <class Kernel>
void scatter_points(OnGpu, int count, const PointGroups& groups, const Kernel& kernel) {
  if (count <= 0) return;
  const KernelTime<OnGpu> time(kernel, count);
  if (groups.in_order) {
    for (const auto& ranges : groups.on_gpu) {
      if (ranges.size() == 0) continue;
      detail::run_tiles_in_order<<<static_cast<unsigned>(ranges.size()), detail::warp_size, 0, detail::gpu_stream()>>>(ranges.data(), kernel);
      detail::gpu_check_launch(__PRETTY_FUNCTION__);
    }
    return;
  }
  constexpr bool fits = 2 * detail::tile_warps * detail::warp_size * sizeof(typename Kernel::Source) <= 65536;  // two blocks of 32 points a warp, and room beside them
  if constexpr (fits) {
    if (count >= points_that_keep_a_gpu_busy) return detail::start_tiles<32>(count, kernel);
  }
  detail::start_tiles<16>(count, kernel);
}
#endif

}  // namespace talus
