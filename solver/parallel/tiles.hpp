// Scatters by tiles: points that stand side by side in memory mostly share their nodes, so that a GPU can sum what they
// give before it goes to memory.
#pragma once

#include <bit>
#include <new>

#include "solver/parallel/for_each.hpp"

namespace talus {

/// Runs a scatter over points. The kernel is one for_each_grouped can run (scatter_point below), with the parts of its
/// work as members:
///   columns_each, deep  columns of nodes that a point has, and nodes of each
///   Source              a point as its nodes see it, made from (kernel, point)
///   Sums                what a node receives, zero to begin with
///   counts(p)           whether the point gives anything
///   grid                the grid of those nodes
///   nodes_of(s)         whose i, j, k are the first node of a source
///   add(s, q, sums)     adds what the nodes of column q of the source receive to sums[deep]
///   column_of(s, q)     where layer 0 of column q is stored, or would be
///   node_in(column, k, c)  where node c of a column of a source whose first layer is k is stored, from that
///   give_to(place, sums)   passes sums on to a stored node
/// and, for the lanes of a warp to pass on together what lies together in memory:
///   Number, parts       what sums are made of, and of how many
///   gives(k, c)         false where node c of such a column is none of its own: two may be stored in one place, but
///   only one of them gives store(sums, to)     puts the parts side by side part(node, q)       where part q of a
///   stored node is has(q)              whether there is such a part; may be left out where all are tiles_at_once
///   blocks of two tiles that a multiprocessor must have registers for; 0, or left out, where any number will do
template <class Kernel>
TALUS_HD void scatter_point(const Kernel& kernel, int p) {
  if (!kernel.counts(p)) return;
  const typename Kernel::Source source(kernel, p);
  for (int q = 0; q < Kernel::columns_each; ++q) {
    typename Kernel::Sums sums[Kernel::deep];
    kernel.add(source, q, sums);
    const int column = kernel.column_of(source, q);
    for (int c = 0; c < Kernel::deep; ++c)
      kernel.give_to(kernel.node_in(column, kernel.nodes_of(source).k, c), sums[c]);
  }
}

template <class Kernel>
void scatter_points(const CpuDevice& device, int count, const PointGroups& groups, const Kernel& kernel) {
  for_each_grouped(device, count, groups, kernel);
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

/// Sorts the keys of a warp's lanes (bitonic; Batcher 1968), unless they are in order.
__device__ inline std::uint64_t sort_lanes(std::uint64_t key) {
  constexpr unsigned all = 0xffffffffu;
  const int lane = static_cast<int>(threadIdx.x) % warp_size;
  const std::uint64_t next = __shfl_down_sync(all, key, 1);
  if (__all_sync(all, lane + 1 == warp_size || key < next)) return key;
  for (int size = 2; size <= warp_size; size *= 2) {
    for (int apart = size / 2; apart > 0; apart /= 2) {
      const std::uint64_t other = __shfl_xor_sync(all, key, apart);
      const bool lower = (lane & apart) == 0, rising = (lane & size) == 0;
      if ((other < key) == (lower == rising)) key = other;
    }
  }
  return key;
}

/// A warp reads `each` points, one a lane, and puts them in the order of their nodes. Then teams take a share of them
/// each, a lane for every column of nodes: sums stay in registers for as long as the next point has the same nodes;
/// where its nodes are those a layer up, only the lowest layer is given away, by one atomic a node (after Gao et al.
/// 2018). With 32 points a block takes 31 kB of shared memory for P2G in double precision.
template <int each, class Kernel>
__device__ void take_tile(int count, const Kernel& kernel) {
  using Source = typename Kernel::Source;
  constexpr unsigned all = 0xffffffffu;
  constexpr int columns = Kernel::columns_each, deep = Kernel::deep, teams = warp_size / columns,
                share = (each + teams - 1) / teams;
  constexpr std::size_t apart_by =
      alignof(Source) *
      (sizeof(Source) / alignof(Source) | 1);  // an odd number of words: neighbouring lanes meet different banks
  __shared__ alignas(16) unsigned char room[tile_warps * each * apart_by];
  __shared__ int bases[tile_warps * each][columns];
  const int lane = static_cast<int>(threadIdx.x) % warp_size, warp = static_cast<int>(threadIdx.x) / warp_size;
  const auto at = [&](int q) -> Source& {
    return *reinterpret_cast<Source*>(room + static_cast<std::size_t>(warp * each + q) * apart_by);
  };
  constexpr int lane_bits = 5, layer_bits = 20;
  std::uint64_t key = ~std::uint64_t{0} << lane_bits |
                      static_cast<unsigned>(lane);  // of a lane whose point does not count: behind all others
  if (lane < each) {
    const int p = (static_cast<int>(blockIdx.x) * tile_warps + warp) * each + lane;
    if (p < count && kernel.counts(p)) {
      const Source& source = *new (&at(lane)) Source(kernel, p);
      for (int q = 0; q < columns; ++q) bases[warp * each + lane][q] = kernel.column_of(source, q);
      const auto& n = kernel.nodes_of(source);
      key = (static_cast<std::uint64_t>(kernel.grid.column(n.i, n.j)) << layer_bits | static_cast<unsigned>(n.k + 1))
                << lane_bits |
            static_cast<unsigned>(lane);
    }
  }
  if (__all_sync(all, key >> 63)) return;
  __syncwarp();  // votes order no memory: what other lanes have written is read from here on
  key = sort_lanes(key);
  const int who = static_cast<int>(key & ((1u << lane_bits) - 1));
  const std::uint64_t nodes = key >> lane_bits, nodes_after = __shfl_down_sync(all, nodes, 1);
  const unsigned counting = __ballot_sync(all, !(key >> 63));
  const unsigned staying = __ballot_sync(all, nodes_after == nodes),
                 climbing = __ballot_sync(all, nodes_after == nodes + 1);  // the next point, that is
  const int team = lane / columns, column = lane % columns;                // lanes beyond the last team help to give
  const int first = team * share, last = team >= teams ? 0 : first + share < each ? first + share : each;
  // In single precision there is an atomic of 16 bytes. One of 8 takes as long as the 32 around it: there, neighbouring
  // lanes add neighbouring parts of one node, not the same part of many nodes, and all lanes give what one team has
  // found.
  constexpr bool together = sizeof(typename Kernel::Number) == 8;
  constexpr int parts = Kernel::parts, apart = static_cast<int>(std::bit_ceil(static_cast<unsigned>(parts)));
  constexpr int at_once = parts <= 10 ? deep : 1,
                given = columns * at_once;  // nodes of a column, and of a team, that there is room for
  __shared__ typename Kernel::Number all_values[together ? tile_warps * teams * given * parts : 1];
  __shared__ int all_places[together ? tile_warps * teams * given : 1];
  const int part = lane % apart;
  const bool mine_to_give = part < parts && has_part(kernel, part);
  typename Kernel::Sums sums[deep];
  for (int step = 0; step < share; ++step) {
    const int q = first + step;
    const int point = __shfl_sync(all, who, q < warp_size ? q : 0);
    const bool adds = q < last && (counting >> q & 1u) != 0, goes_on = adds && q + 1 < last;
    if (adds) kernel.add(at(point), column, sums);
    const bool climbs = goes_on && (climbing >> q & 1u) != 0, ends = adds && !(goes_on && (staying >> q & 1u) != 0);
    if constexpr (!together) {
      if (!ends) continue;
      TALUS_UNROLL
      for (int c = 0; c < deep; ++c) {
        if (c == 0 || !climbs)
          kernel.give_to(kernel.node_in(bases[warp * each + point][column], kernel.nodes_of(at(point)).k, c), sums[c]);
      }
    } else {
      const unsigned whole = __ballot_sync(all, ends && !climbs);
      if (__ballot_sync(all, ends) == 0) continue;
      TALUS_UNROLL
      for (int from = 0; from < deep; from += at_once) {
        const bool gives = ends && (from == 0 || !climbs);
        const unsigned giving = __ballot_sync(all, gives);
        if (gives) {
          TALUS_UNROLL
          for (int c = from; c < from + at_once; ++c) {
            const int n = (warp * teams + team) * given + (c - from) * columns + column;
            kernel.store(sums[c], all_values + n * parts);
            all_places[n] = kernel.node_in(bases[warp * each + point][column], kernel.nodes_of(at(point)).k, c);
          }
        }
        __syncwarp();
        for (int g = 0; g < teams; ++g) {
          if ((giving >> (g * columns) & 1u) == 0) continue;
          const auto* const values = all_values + (warp * teams + g) * given * parts;
          const int* const places = all_places + (warp * teams + g) * given;
          const int to_give = (whole >> (g * columns) & 1u) != 0 ? given : columns;
          if (!mine_to_give) continue;
          for (int n = lane / apart; n < to_give; n += warp_size / apart)
            atomicAdd(kernel.part(places[n], part), values[n * parts + part]);
        }
        __syncwarp();
      }
      if (!ends) continue;
    }
    TALUS_UNROLL
    for (int c = 0; c < deep; ++c) {
      if (climbs && c + 1 < deep) {
        sums[c] = sums[c + 1];
      } else {
        sums[c] = {};
      }
    }
  }
}

template <int each, class Kernel>
__global__ void run_tiles(int count, Kernel kernel) {
  begin_kernel();
  take_tile<each>(count, kernel);
}

/// The same in as many registers as let this number of blocks share a multiprocessor.
template <int each, int blocks, class Kernel>
__global__ __launch_bounds__(tile_warps* warp_size, blocks) void run_tiles_densely(int count, Kernel kernel) {
  begin_kernel();
  take_tile<each>(count, kernel);
}

template <int each, class Kernel>
void start_tiles(const GpuDevice& device, int count, const Kernel& kernel) {
  constexpr int points = tile_warps * each;
  const int blocks = (count + points - 1) / points;
  if constexpr (requires { Kernel::tiles_at_once; }) {
    if constexpr (Kernel::tiles_at_once > 0) {
      return gpu_launch(device, __PRETTY_FUNCTION__, run_tiles_densely<each, Kernel::tiles_at_once, Kernel>, blocks,
                        tile_warps * warp_size, count, kernel);
    }
  }
  gpu_launch(device, __PRETTY_FUNCTION__, run_tiles<each, Kernel>, blocks, tile_warps * warp_size, count, kernel);
}

/// A warp takes the points of a block of columns one after the other, a lane for every column of nodes.
template <class Kernel>
__global__ void run_tiles_in_order(const PointGroups::Range* ranges, Kernel kernel) {
  begin_kernel();
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
          if (!kernel.gives(kernel.nodes_of(tile[q]).k, c)) continue;
          typename Kernel::Number parts[Kernel::parts];
          kernel.store(sums[c], parts);
          const int node = kernel.node_in(column, kernel.nodes_of(tile[q]).k, c);
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
void scatter_points(const GpuDevice& device, int count, const PointGroups& groups, const Kernel& kernel) {
  if (count <= 0) return;
  const KernelTime<GpuDevice> time(device, kernel, count);
  if (groups.in_order) {
    for (const auto& ranges : groups.on_gpu) {
      if (ranges.size() == 0) continue;
      detail::gpu_launch(device, __PRETTY_FUNCTION__, detail::run_tiles_in_order<Kernel>,
                         static_cast<int>(ranges.size()), detail::warp_size, ranges.data(), kernel);
    }
    return;
  }
  constexpr bool fits = 2 * detail::tile_warps * detail::warp_size * sizeof(typename Kernel::Source) <=
                        65536;  // two blocks of 32 points a warp, and room beside them
  if constexpr (fits) {
    if (count >= points_that_keep_a_gpu_busy) return detail::start_tiles<32>(device, count, kernel);
  }
  detail::start_tiles<16>(device, count, kernel);
}
#endif

}  // namespace talus
