// Scatters by tiles: points that stand side by side in memory mostly share their nodes, so that a GPU can sum what they give before it goes to memory.
#pragma once

#include <bit>
#include <new>

#include "solver/parallel/place.hpp"

namespace talus {

/// Runs a scatter over points. The kernel is one for_each_grouped can run (scatter_point below), with the parts of its work as members:
///   columns_each, deep  columns of nodes that a point has, and nodes of each
///   Source              a point as its nodes see it, made from (kernel, point)
///   Sums                what a node receives, zero to begin with
///   counts(p)           whether the point gives anything
///   same_nodes(s, t)    whether two sources have the same nodes
///   add(s, q, sums)     adds what the nodes of column q of the source receive to sums[deep]
///   column_of(s, q)     where layer 0 of column q is stored, or would be
///   node_in(column, s, c)  where node c of a column of the source is stored, from that
///   give_to(place, sums)   passes sums on to a stored node
/// and, for the lanes of a warp to pass on together what lies together in memory:
///   Number, parts       what sums are made of, and of how many
///   gives(s, c)         false where node c of a column is none of its own: two may be stored in one place, but only one of them gives
///   store(sums, to)     puts the parts side by side
///   part(node, q)       where part q of a stored node is
///   has(q)              whether there is such a part; may be left out where all are
template <class Kernel>
TALUS_HD void scatter_point(const Kernel& kernel, int p) {
  if (!kernel.counts(p)) return;
  const typename Kernel::Source source(kernel, p);
  for (int q = 0; q < Kernel::columns_each; ++q) {
    typename Kernel::Sums sums[Kernel::deep];
    kernel.add(source, q, sums);
    const int column = kernel.column_of(source, q);
    for (int c = 0; c < Kernel::deep; ++c) kernel.give_to(kernel.node_in(column, source, c), sums[c]);
  }
}

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

/// A warp reads `each` points, one a lane. Then teams take a share of them each, a lane for every column of nodes: sums stay in registers for as long as the next point has the same
/// nodes, and go out by one atomic a node (after Gao et al. 2018). With 32 points a block takes 33 kB of shared memory for P2G in double precision.
template <int each, class Kernel>
__global__ void run_tiles(int count, Kernel kernel) {
  using Source = typename Kernel::Source;
  constexpr int columns = Kernel::columns_each, teams = warp_size / columns, share = (each + teams - 1) / teams;
  __shared__ alignas(16) unsigned char room[tile_warps * each * sizeof(Source)];
  __shared__ int bases[tile_warps * each][columns];
  const int lane = static_cast<int>(threadIdx.x) % warp_size, warp = static_cast<int>(threadIdx.x) / warp_size;
  auto* const tile = reinterpret_cast<Source*>(room) + warp * each;
  bool counts = false;
  if (lane < each) {
    const int p = (static_cast<int>(blockIdx.x) * tile_warps + warp) * each + lane;
    counts = p < count && kernel.counts(p);
    if (counts) {
      const Source& source = *new (tile + lane) Source(kernel, p);
      for (int q = 0; q < columns; ++q) bases[warp * each + lane][q] = kernel.column_of(source, q);
    }
  }
  constexpr unsigned all = 0xffffffffu;
  const unsigned counting = __ballot_sync(all, counts);
  if (counting == 0) return;
  const bool goes_on = counts && lane + 1 < each && (counting >> (lane + 1) & 1u) != 0 && kernel.same_nodes(tile[lane], tile[lane + 1]);
  const unsigned going_on = __ballot_sync(all, goes_on);
  const int team = lane / columns, column = lane % columns;  // lanes beyond the last team help to give
  const int first = team * share, last = team >= teams ? 0 : first + share < each ? first + share : each;
  // In single precision there is an atomic of 16 bytes. One of 8 takes as long as the 32 around it: there, neighbouring lanes add neighbouring parts of one node, not the same
  // part of many nodes, and all lanes give what one team has found.
  constexpr bool together = sizeof(typename Kernel::Number) == 8;
  constexpr int parts = Kernel::parts, apart = static_cast<int>(std::bit_ceil(static_cast<unsigned>(parts)));
  constexpr int at_once = parts <= 10 ? Kernel::deep : 1, given = columns * at_once;  // nodes of a column, and of a team, that there is room for
  __shared__ typename Kernel::Number all_values[together ? tile_warps * teams * given * parts : 1];
  __shared__ int all_places[together ? tile_warps * teams * given : 1];
  const int part = lane % apart;
  const bool mine_to_give = part < parts && has_part(kernel, part);
  typename Kernel::Sums sums[Kernel::deep];
  for (int step = 0; step < share; ++step) {
    const int q = first + step;
    const bool adds = q < last && (counting >> q & 1u) != 0;
    if (adds) kernel.add(tile[q], column, sums);
    const bool ends = adds && !(q + 1 < last && (going_on >> q & 1u) != 0);
    if constexpr (!together) {
      if (!ends) continue;
      for (int c = 0; c < Kernel::deep; ++c) {
        kernel.give_to(kernel.node_in(bases[warp * each + q][column], tile[q], c), sums[c]);
        sums[c] = {};
      }
    } else {
      const unsigned giving = __ballot_sync(all, ends);
      if (giving == 0) continue;
      TALUS_UNROLL
      for (int from = 0; from < Kernel::deep; from += at_once) {
        if (ends) {
          for (int c = from; c < from + at_once; ++c) {
            const int n = (warp * teams + team) * given + (c - from) * columns + column;
            kernel.store(sums[c], all_values + n * parts);
            all_places[n] = kernel.node_in(bases[warp * each + q][column], tile[q], c);
            sums[c] = {};
          }
        }
        __syncwarp();
        for (int g = 0; g < teams; ++g) {
          if ((giving >> (g * columns) & 1u) == 0) continue;
          const auto* const values = all_values + (warp * teams + g) * given * parts;
          const int* const places = all_places + (warp * teams + g) * given;
          if (!mine_to_give) continue;
          for (int n = lane / apart; n < given; n += warp_size / apart) atomicAdd(kernel.part(places[n], part), values[n * parts + part]);
        }
        __syncwarp();
      }
    }
  }
}

template <int each, class Kernel>
void start_tiles(int count, const Kernel& kernel) {
  constexpr int points = tile_warps * each;
  run_tiles<each><<<(count + points - 1) / points, tile_warps * warp_size, 0, gpu_stream()>>>(count, kernel);
  gpu_check_launch(__PRETTY_FUNCTION__);
}

/// A warp takes the points of a block of columns one after the other, a lane for every column of nodes.
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
      if (lane < Kernel::columns_each) {
        typename Kernel::Sums sums[Kernel::deep];
        kernel.add(tile[q], lane, sums);
        const int column = kernel.column_of(tile[q], lane);
        for (int c = 0; c < Kernel::deep; ++c) {
          if (!kernel.gives(tile[q], c)) continue;
          typename Kernel::Number parts[Kernel::parts];
          kernel.store(sums[c], parts);
          const int node = kernel.node_in(column, tile[q], c);
          for (int part = 0; part < Kernel::parts; ++part) {
            if (has_part(kernel, part)) *kernel.part(node, part) += parts[part];
          }
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
