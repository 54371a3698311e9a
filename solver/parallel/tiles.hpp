// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scatters by tiles: points that lie side by side in memory mostly share their nodes, so that a GPU can sum what they
// give before it goes to memory.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <new>
#include <type_traits>

#include "solver/parallel/for_each.hpp"

namespace talus {

/// A scatter over points, with the parts of its work as members, so that the lanes of a warp can pass on together what
/// lies together in memory. `s` is a source, `q` one of its columns of nodes, `c` a node of a column, lowest first:
///   columns_each, deep     columns of nodes that a point has, and nodes of each
///   Source                 a point as its nodes see it, made from (kernel, point)
///   Sums                   what a node receives, zero to begin with
///   Number, parts          what sums are made of, and of how many
///   grid                   the grid of the nodes
///   counts(p)              whether point p gives anything
///   nodes_of(s)            whose i, j, k are the first node of s
///   add(s, q, sums)        adds what the nodes of column q receive from s to sums[deep]
///   column_of(s, q)        where layer 0 of column q is stored, or would be
///   node_in(column, k, c)  where node c of a column whose first layer is k is stored
///   owns(k, c)             false where that node is another's: two may be stored in one location
///   add_to_node(n, sums)   adds sums to stored node n, whoever else does
///   store(sums, to)        puts the parts of sums side by side
///   part(n, r)             location of part r of stored node n
/// and, where a kernel has them, has(r), whether there is a part r (all, otherwise), and tiles_at_once, the blocks of
/// two tiles that a multiprocessor must have registers for (0, or none: any number will do).
template <class Kernel>
concept ScatterKernel = std::is_constructible_v<typename Kernel::Source, const Kernel&, int> &&
    requires(const Kernel& kernel, const typename Kernel::Source& s, typename Kernel::Sums (&sums)[Kernel::deep],
             typename Kernel::Number* to, int n) {
  { Kernel::columns_each + Kernel::deep + Kernel::parts } -> std::convertible_to<int>;
  { kernel.counts(n) } -> std::same_as<bool>;
  { kernel.grid.column(kernel.nodes_of(s).i, kernel.nodes_of(s).j) } -> std::convertible_to<int>;
  { kernel.nodes_of(s).k } -> std::convertible_to<int>;
  kernel.add(s, n, sums);
  { kernel.column_of(s, n) } -> std::same_as<int>;
  { kernel.node_in(n, n, n) } -> std::same_as<int>;
  { kernel.owns(n, n) } -> std::same_as<bool>;
  kernel.add_to_node(n, sums[0]);
  kernel.store(sums[0], to);
  { kernel.part(n, n) } -> std::same_as<typename Kernel::Number*>;
};

/// A scatter of vectors that parts the work on a column among as many lanes as they have components. In place of Sums,
/// Number, parts, store(), part() and add_to_node() it has
///   shares                              how many lanes part the work on a column
///   Share                               what its nodes receive from one of them, zero to begin with: a component of
///                                       each vector, and the scalars of the node whose number is that of the share
///   add(s, q, t, share)                 adds share t of what the nodes of column q receive from s
///   give_vectors(share, t, c, n, give)  calls give(number, sum) for share t of the vectors of node c, stored as node n
///   give_scalars(share, t, n, give)     the same for the scalars, of node t
/// On a CPU it scatters a point alone, as it sees fit.
template <class Kernel>
concept SharedScatter = requires {
  typename Kernel::Share;
};

/// This function does a scatter's work for one point, alone.
template <ScatterKernel Kernel>
TALUS_HD void scatter_point(const Kernel& kernel, int p) {
  if (!kernel.counts(p)) return;
  const typename Kernel::Source source(kernel, p);
  for (int q = 0; q < Kernel::columns_each; ++q) {
    typename Kernel::Sums sums[Kernel::deep];
    kernel.add(source, q, sums);
    const int column = kernel.column_of(source, q);
    for (int c = 0; c < Kernel::deep; ++c)
      kernel.add_to_node(kernel.node_in(column, kernel.nodes_of(source).k, c), sums[c]);
  }
}

/// No second scatter.
struct NoScatter {};

/// This function runs a scatter over `count` points, and where there is a second one, that too where acts() says so. On
/// the CPU each point scatters alone, by scatter_point().
template <class Kernel, class Also = NoScatter>
void scatter_points(const CpuDevice& device, int count, const PointGroups& groups, const Kernel& kernel,
                    const Also& also = {}) {
  for_each_grouped(device, count, groups, kernel);
  if constexpr (ScatterKernel<Also>) {
    if (also.acts()) for_each_grouped(device, count, groups, also);
  }
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

/// What the tiles of a shared scatter hold in shared memory.
template <int each, class Kernel>
struct SharedTileMemory {
  using Source = typename Kernel::Source;
  /// Bytes from source to source: an odd number of those that are read at once, so that lanes meet different banks.
  static constexpr std::size_t source_bytes = alignof(Source) * (sizeof(Source) / alignof(Source) | 1),
                               held = tile_warps * each;
  alignas(16) unsigned char sources[held * source_bytes];
  int bases[held][Kernel::columns_each];  ///< where layer 0 of every column of a source is stored
  int order[tile_warps * warp_size];      ///< the sources of a warp in the order of their nodes

  __device__ Source& source(int n) {
    return *reinterpret_cast<Source*>(sources + static_cast<std::size_t>(n) * source_bytes);
  }
};

/// How a warp parts the work on `each` points: teams take a share of the points each, a lane for every column of nodes.
template <int each, class Kernel>
struct TileSizes {
  static constexpr int columns = Kernel::columns_each, deep = Kernel::deep, parts = Kernel::parts;
  static constexpr int teams = warp_size / columns, share = (each + teams - 1) / teams;
  /// Bytes from source to source: an odd number of words, so that neighbouring lanes meet different banks.
  static constexpr std::size_t source_bytes =
      alignof(typename Kernel::Source) * (sizeof(typename Kernel::Source) / alignof(typename Kernel::Source) | 1);
  /// In single precision there is an atomic of 16 bytes. One of 8 takes as long as the 32 around it: there,
  /// neighbouring lanes add neighbouring parts of one node, not the same part of many nodes, and all lanes add what one
  /// team has found.
  static constexpr bool together = sizeof(typename Kernel::Number) == 8;
  static constexpr int lanes_of_a_node = static_cast<int>(std::bit_ceil(static_cast<unsigned>(parts)));
  /// Nodes of a column, and of a team, that there is memory for at a time.
  static constexpr int layers_at_once = parts <= 10 ? deep : 1, nodes_at_once = columns * layers_at_once;
  static constexpr int passed_on = together ? tile_warps * teams * nodes_at_once : 0;  ///< nodes of all teams
};

/// Shared memory of a block of two tiles: with 32 points a warp 31 kB for P2G in double precision.
template <int each, class Kernel>
struct TileMemory {
  using Source = typename Kernel::Source;
  using Sizes = TileSizes<each, Kernel>;
  static constexpr std::size_t held = tile_warps * each, columns = Sizes::columns;
  alignas(16) unsigned char sources[held * Sizes::source_bytes];
  int bases[held][columns];  ///< where layer 0 of every column of a source is stored
  typename Kernel::Number values[Sizes::together ? Sizes::passed_on * Sizes::parts : 1];
  int nodes[Sizes::together ? Sizes::passed_on : 1];

  __device__ Source& source(int q) {
    return *reinterpret_cast<Source*>(sources + static_cast<std::size_t>(q) * Sizes::source_bytes);
  }
};

/// What a lane of a tile is. Only what the addresses in shared memory begin with is kept: the kernels are short of
/// registers, and P2G takes 8 % longer where that is worked out for every point.
template <int each, class Kernel>
struct TileLane {
  using Sizes = TileSizes<each, Kernel>;
  int first_source = static_cast<int>(threadIdx.x) / warp_size * each;  ///< of this warp
  __device__ int lane() const { return static_cast<int>(threadIdx.x) % warp_size; }
  __device__ int warp() const { return static_cast<int>(threadIdx.x) / warp_size; }
  __device__ int team() const { return lane() / Sizes::columns; }  ///< lanes beyond the last team help to pass on
  __device__ int column() const { return lane() % Sizes::columns; }
};

inline constexpr int lane_bits = 5, layer_bits = 20;

/// Reads the lane's point into shared memory. Returns a key that orders the points by their first node; that of a lane
/// whose point does not count is behind all others.
template <int each, class Kernel, class Memory>
__device__ __forceinline__ std::uint64_t read_point(int count, int block, const Kernel& kernel, Memory& memory) {
  const int lane = static_cast<int>(threadIdx.x) % warp_size, warp = static_cast<int>(threadIdx.x) / warp_size;
  const std::uint64_t nothing = ~std::uint64_t{0} << lane_bits | static_cast<unsigned>(lane);
  if (lane >= each) return nothing;
  const int at = warp * each + lane, p = block * tile_warps * each + at;
  if (p >= count || !kernel.counts(p)) return nothing;
  const auto& source = *new (&memory.source(at)) typename Kernel::Source(kernel, p);
  for (int q = 0; q < Kernel::columns_each; ++q) memory.bases[at][q] = kernel.column_of(source, q);
  const auto& n = kernel.nodes_of(source);
  return (static_cast<std::uint64_t>(kernel.grid.column(n.i, n.j)) << layer_bits | static_cast<unsigned>(n.k + 1))
             << lane_bits |
         static_cast<unsigned>(lane);
}

/// The points of a tile in the order of their nodes: bit q of each word is of the q-th.
struct TileOrder {
  int point;          ///< lane that has read the point of this lane's rank
  unsigned counting;  ///< the point counts
  unsigned staying;   ///< the next one has the same nodes
  unsigned climbing;  ///< the next one has those a layer up
};

__device__ __forceinline__ TileOrder order_points(std::uint64_t key) {
  constexpr unsigned all = 0xffffffffu;
  __syncwarp();  // votes order no memory: what other lanes have written is read from here on
  key = sort_lanes(key);
  const std::uint64_t nodes = key >> lane_bits, nodes_after = __shfl_down_sync(all, nodes, 1);
  return {static_cast<int>(key & ((1u << lane_bits) - 1)), __ballot_sync(all, !(key >> 63)),
          __ballot_sync(all, nodes_after == nodes), __ballot_sync(all, nodes_after == nodes + 1)};
}

/// Adds the sums of every lane that `ends` a run of points to the nodes of its column, those of the lowest layer alone
/// where it `climbs`: all lanes of the warp, for one team after the other, neighbouring parts of a node at a time.
/// `source` is the last point's.
template <int each, class Kernel>
__device__ __forceinline__ void add_together(const Kernel& kernel, const TileLane<each, Kernel>& at,
                                             TileMemory<each, Kernel>& memory, int source, bool ends, bool climbs,
                                             const typename Kernel::Sums (&sums)[Kernel::deep]) {
  using Sizes = TileSizes<each, Kernel>;
  constexpr unsigned all = 0xffffffffu;
  constexpr int lanes = Sizes::lanes_of_a_node, parts = Sizes::parts;
  const int part = at.lane() % lanes;
  const bool adds_part = part < parts && has_part(kernel, part);
  const unsigned whole = __ballot_sync(all, ends && !climbs);
  if (__ballot_sync(all, ends) == 0) return;
  TALUS_UNROLL
  for (int from = 0; from < Sizes::deep; from += Sizes::layers_at_once) {
    const bool passes = ends && (from == 0 || !climbs);
    const unsigned passing = __ballot_sync(all, passes);
    if (passes) {
      TALUS_UNROLL
      for (int c = from; c < from + Sizes::layers_at_once; ++c) {
        const int n =
            (at.warp() * Sizes::teams + at.team()) * Sizes::nodes_at_once + (c - from) * Sizes::columns + at.column();
        kernel.store(sums[c], memory.values + n * parts);
        memory.nodes[n] =
            kernel.node_in(memory.bases[source][at.column()], kernel.nodes_of(memory.source(source)).k, c);
      }
    }
    __syncwarp();
    for (int g = 0; g < Sizes::teams; ++g) {
      if ((passing >> (g * Sizes::columns) & 1u) == 0) continue;
      const int begin = (at.warp() * Sizes::teams + g) * Sizes::nodes_at_once;
      const auto* const values = memory.values + begin * parts;
      const int* const nodes = memory.nodes + begin;
      const int number = (whole >> (g * Sizes::columns) & 1u) != 0 ? Sizes::nodes_at_once : Sizes::columns;
      if (!adds_part) continue;
      for (int n = at.lane() / lanes; n < number; n += warp_size / lanes)
        scatter_add(kernel.part(nodes[n], part), values[n * parts + part]);
    }
    __syncwarp();
  }
}

/// Adds the sums of a lane whose run of points ends to the nodes of its column; where it climbs, the lowest layer's.
template <int each, class Kernel>
__device__ __forceinline__ void add_alone(const Kernel& kernel, const TileLane<each, Kernel>& at,
                                          TileMemory<each, Kernel>& memory, int source, bool climbs,
                                          const typename Kernel::Sums (&sums)[Kernel::deep]) {
  TALUS_UNROLL
  for (int c = 0; c < Kernel::deep; ++c) {
    if (c > 0 && climbs) continue;
    const int k = kernel.nodes_of(memory.source(source)).k;
    kernel.add_to_node(kernel.node_in(memory.bases[source][at.column()], k, c), sums[c]);
  }
}

/// Sums what `each` points a warp give to their nodes before it goes to memory (after Gao et al. 2018). A warp reads
/// one point a lane and orders them by their nodes; its teams go through a share of them each, with the sums of a
/// column in registers for as long as the next point has the same nodes. Where its nodes are those a layer up, only the
/// lowest layer is passed on.
template <int each, class Kernel>
__device__ void reduce_tile(int count, int block, const Kernel& kernel, TileMemory<each, Kernel>& memory) {
  using Sizes = TileSizes<each, Kernel>;
  constexpr unsigned all = 0xffffffffu;
  const TileLane<each, Kernel> at;
  const std::uint64_t key = read_point<each>(count, block, kernel, memory);
  if (__all_sync(all, key >> 63)) return;
  const TileOrder order = order_points(key);
  const int first = at.team() * Sizes::share;
  const int last = at.team() >= Sizes::teams ? 0 : first + Sizes::share < each ? first + Sizes::share : each;
  typename Kernel::Sums sums[Sizes::deep];
  for (int step = 0; step < Sizes::share; ++step) {
    const int q = first + step;
    const int source = at.first_source + __shfl_sync(all, order.point, q < warp_size ? q : 0);
    const bool adds = q < last && (order.counting >> q & 1u) != 0, goes_on = adds && q + 1 < last;
    if (adds) kernel.add(memory.source(source), at.column(), sums);
    const bool climbs = goes_on && (order.climbing >> q & 1u) != 0,
               ends = adds && !(goes_on && (order.staying >> q & 1u) != 0);
    if constexpr (Sizes::together) add_together<each>(kernel, at, memory, source, ends, climbs, sums);
    if (!ends) continue;
    if constexpr (!Sizes::together) add_alone<each>(kernel, at, memory, source, climbs, sums);
    TALUS_UNROLL
    for (int c = 0; c < Sizes::deep; ++c) {
      if (climbs && c + 1 < Sizes::deep) {
        sums[c] = sums[c + 1];
      } else {
        sums[c] = {};
      }
    }
  }
}

/// The same for a scatter that parts the work on a column: a team has a lane for every share of every column. What
/// lanes of one column add lies side by side: an atomic of 8 bytes takes as long as the 32 around it.
template <int each, SharedScatter Kernel>
__device__ void reduce_tile(int count, int block, const Kernel& kernel, SharedTileMemory<each, Kernel>& memory) {
  constexpr int columns = Kernel::columns_each, deep = Kernel::deep, members = columns * Kernel::shares,
                teams = warp_size / members, part = (each + teams - 1) / teams;
  const std::uint64_t key = read_point<each>(count, block, kernel, memory);
  if (__all_sync(0xffffffffu, key >> 63)) return;
  const TileOrder order = order_points(key);
  const int lane = static_cast<int>(threadIdx.x) % warp_size, warp = static_cast<int>(threadIdx.x) / warp_size,
            team = lane / members, q = lane % columns, t = lane % members / columns;
  int* const places = memory.order + warp * warp_size;
  places[lane] = warp * each + order.point;
  __syncwarp();
  const int counting = __popc(order.counting), first = team * part;
  const int last = team >= teams ? 0 : first + part < counting ? first + part : counting;
  const auto add_to = [](auto* number, auto value) { scatter_add(number, value); };
  typename Kernel::Share share;
  for (int n = first; n < last; ++n) {
    const int at = places[n];
    const auto& source = memory.source(at);
    kernel.add(source, q, t, share);
    if (n + 1 < last && (order.staying >> n & 1u) != 0) continue;
    const bool climbs = n + 1 < last && (order.climbing >> n & 1u) != 0;
    const int base = memory.bases[at][q], k = kernel.nodes_of(source).k;
    typename Kernel::Share next;
    kernel.give_scalars(share, t, kernel.node_in(base, k, t), add_to);
    kernel.give_vectors(share, t, 0, kernel.node_in(base, k, 0), add_to);
    TALUS_UNROLL
    for (int c = 1; c < deep; ++c) {
      if (climbs) {
        next.momentum[c - 1] = share.momentum[c];
        next.force[c - 1] = share.force[c];
      } else {
        kernel.give_vectors(share, t, c, kernel.node_in(base, k, c), add_to);
      }
    }
    share = next;
  }
}

/// What the tiles of a scatter hold in shared memory.
template <int each, class Kernel>
struct TileRoom {
  using Memory = TileMemory<each, Kernel>;
};
template <int each, SharedScatter Kernel>
struct TileRoom<each, Kernel> {
  using Memory = SharedTileMemory<each, Kernel>;
};
template <int each>
struct TileRoom<each, NoScatter> {
  using Memory = NoScatter;
};

/// A block of threads for two tiles of points, as it is launched. A second scatter comes after the first one in the
/// same shared memory.
template <int each, class Kernel, class Also>
struct EachTile {
  using Named = Kernel;
  int count;
  Kernel kernel;
  Also also;
  __device__ void run(LaunchBlock at) const {
    __shared__ union {
      typename TileRoom<each, Kernel>::Memory first;
      typename TileRoom<each, Also>::Memory second;
    } room;
    reduce_tile<each>(count, at.index, kernel, room.first);
    if constexpr (ScatterKernel<Also>) {
      if (!also.acts()) return;
      __syncthreads();
      reduce_tile<each>(count, at.index, also, room.second);
    }
  }
};

/// The same in as many registers as let this number of blocks share a multiprocessor.
template <int each, int blocks, class Kernel, class Also>
struct EachTileDensely : EachTile<each, Kernel, Also> {
  static constexpr int most_threads = tile_warps * warp_size, least_blocks = blocks;
};

template <int each, class Kernel, class Also>
void start_tiles(const GpuDevice& device, int count, const Kernel& kernel, const Also& also) {
  constexpr int points = tile_warps * each, threads = tile_warps * warp_size;
  const int blocks = (count + points - 1) / points;
  if constexpr (requires { Kernel::tiles_at_once; }) {
    if constexpr (Kernel::tiles_at_once > 0) {
      return gpu_launch(device, __PRETTY_FUNCTION__, blocks, threads,
                        EachTileDensely<each, Kernel::tiles_at_once, Kernel, Also>{{count, kernel, also}});
    }
  }
  gpu_launch(device, __PRETTY_FUNCTION__, blocks, threads, EachTile<each, Kernel, Also>{count, kernel, also});
}

/// A warp takes the points of a block of columns one after the other, a lane for every column of nodes.
template <class Kernel>
struct EachTileInOrder {
  using Named = Kernel;
  const PointGroups::Range* ranges;
  Kernel kernel;
  __device__ void run(LaunchBlock at) const {
    using Source = typename Kernel::Source;
    __shared__ alignas(16) unsigned char room[warp_size * sizeof(Source)];
    __shared__ bool counts[warp_size];
    auto* const tile = reinterpret_cast<Source*>(room);
    const int begin = ranges[at.index].first, end = ranges[at.index].second, lane = static_cast<int>(threadIdx.x);
    for (int first = begin; first < end; first += warp_size) {
      __syncwarp();
      const int p = first + lane;
      counts[lane] = p < end && kernel.counts(p);
      if (counts[lane]) new (tile + lane) Source(kernel, p);
      __syncwarp();
      for (int q = 0; q < warp_size; ++q) {
        if (!counts[q]) continue;
        if constexpr (SharedScatter<Kernel>) {
          const int column = lane % Kernel::columns_each, t = lane / Kernel::columns_each,
                    k = kernel.nodes_of(tile[q]).k;
          if (t < Kernel::shares) {
            const auto add_to = [](auto* number, auto value) { *number += value; };
            typename Kernel::Share share;
            kernel.add(tile[q], column, t, share);
            const int base = kernel.column_of(tile[q], column);
            for (int c = 0; c < Kernel::deep; ++c) {
              if (kernel.owns(k, c)) kernel.give_vectors(share, t, c, kernel.node_in(base, k, c), add_to);
            }
            if (kernel.owns(k, t)) kernel.give_scalars(share, t, kernel.node_in(base, k, t), add_to);
          }
        } else if (lane < Kernel::columns_each) {
          typename Kernel::Sums sums[Kernel::deep];
          kernel.add(tile[q], lane, sums);
          const int column = kernel.column_of(tile[q], lane);
          for (int c = 0; c < Kernel::deep; ++c) {
            if (!kernel.owns(kernel.nodes_of(tile[q]).k, c)) continue;
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
};

}  // namespace detail

/// On a GPU warps scatter tiles of points, and add what their lanes have in common before it goes to memory; with
/// groups.in_order a block takes the points of a column block, colour by colour.
template <class Kernel, class Also = NoScatter>
void scatter_points(const GpuDevice& device, int count, const PointGroups& groups, const Kernel& kernel,
                    const Also& also = {}) {
  if (count <= 0) return;
  if (groups.in_order) {
    const KernelTime<GpuDevice> time(device, kernel, count);
    for (const auto& ranges : groups.on_gpu) {
      if (ranges.size() == 0) continue;
      detail::gpu_launch(device, __PRETTY_FUNCTION__, static_cast<int>(ranges.size()), detail::warp_size,
                         detail::EachTileInOrder<Kernel>{ranges.data(), kernel});
    }
    if constexpr (ScatterKernel<Also>) scatter_points(device, count, groups, also);
    return;
  }
  const KernelTime<GpuDevice> time(device, kernel, count);
  constexpr bool fits = 2 * detail::tile_warps * detail::warp_size * sizeof(typename Kernel::Source) <=
                        65536;  // two blocks of 32 points a warp, and room beside them
  if constexpr (fits) {
    if (detail::is_busy_with(count)) return detail::start_tiles<32>(device, count, kernel, also);
  }
  detail::start_tiles<16>(device, count, kernel, also);
}
#endif

}  // namespace talus
