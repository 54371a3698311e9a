// Particle to grid (P2G): mass, momentum and force of the points onto the nodes around them.
#pragma once

#include <new>

#include "solver/integrator/clock.hpp"
#include "solver/material/material.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus {

namespace detail {
inline constexpr int tile_points = 64;  // of a block on the GPU: 26 kB of its shared memory in double precision
}

/// What P2G scatters.
enum class Scatter {
  impulse,         // momentum + dt * internal force, in one
  force,           // momentum and internal force apart (FLIP, damping, MUSL)
  momentum         // momentum alone (second mapping of MUSL)
};

/// Adds the points to nodes[] (mass, momentum) and, for Scatter::force, forces[].
template <class Real, class Shape, Scatter what>
struct ParticleToGrid {
  static constexpr int width = Shape::width;
  GridView<Real> grid;
  ParticleView<Real> points;
  Material<Real> material;
  const Clock* clock;
  Vec4<Real>* nodes;
  Vec4<Real>* forces;
  const Vec3<double>* loads;  // force per volume of each load [N/m3]; null without loads
  bool affine;
  bool dilatant;

  /// A point as its nodes see it.
  struct Source : Stencil<Real, Shape> {
    Real mass;
    Vec3<Real> corner;    // velocity at the first node
    Mat3<Real> turn{};    // its change per node
    Mat3<Real> pull{};    // columns of -V tau, mapped to reference coordinates and per cell
    Vec3<Real> pulled{};  // by its load, in the units of `pull`

    TALUS_HD Source(const ParticleToGrid& kernel, int p) : Stencil<Real, Shape>(kernel.grid, kernel.points, p) {
      const ParticleView<Real>& points = kernel.points;
      const Real volume = points.volume[p];
      mass = volume * kernel.material.density;
      if constexpr (what != Scatter::momentum) {
        const MaterialState<Real> state{points.elastic_of(p), points.log_volume[p], kernel.dilatant ? points.plastic_log_volume[p] : Real(0)};
        const Sym3<Real> tau = kirchhoff_stress(kernel.material, state);
        const Real dt = what == Scatter::impulse ? Real(kernel.clock->step_size) : Real(1);
        const Real across = -volume * dt / kernel.grid.spacing, up = -volume * dt / kernel.grid.layer_height;
        pull.a = Vec3<Real>{tau.xx, tau.xy, tau.xz} * across;
        pull.b = Vec3<Real>{tau.xy, tau.yy, tau.yz} * across;
        pull.c = (Vec3<Real>{tau.xz, tau.yz, tau.zz} - Vec3<Real>{tau.xx, tau.xy, tau.xz} * this->slope_x - Vec3<Real>{tau.xy, tau.yy, tau.yz} * this->slope_y) * up;
        if (kernel.loads && points.load[p] >= 0) {
          const Vec3<double> f = kernel.loads[points.load[p]];
          pulled = Vec3<Real>{Real(f.x), Real(f.y), Real(f.z)} * (volume * dt);
        }
      }
      corner = points.velocity_of(p);
      if (kernel.affine) {
        turn = points.affine_of(p);
        corner += turn * Vec3<Real>{this->near_x, this->near_y, this->near_z};
      }
    }
  };

  /// What a node receives.
  struct Sums {
    Real mass = 0;
    Vec3<Real> momentum, force;
  };

  /// One thread: one point.
  TALUS_HD void operator()(int p) const {
    if (!counts(p)) return;
    const Source s(*this, p);
    for (int b = 0; b < width; ++b) {
      for (int a = 0; a < width; ++a) {
        const Upright u = upright(s, a, b);
        for (int c = 0; c < width; ++c) {
          Sums sums;
          add(s, u, c, sums);
          give(s.i + a, s.j + b, s.k + c, sums);
        }
      }
    }
  }

  TALUS_HD bool counts(int p) const { return clock->halt == running && points.cell_x[p] >= 0; }

  /// What the nodes of one column of a point's stencil share.
  struct Upright {
    Real weight;
    Vec3<Real> velocity, sideways;
  };
  TALUS_HD Upright upright(const Source& s, int a, int b) const {
    Upright u{s.wx[a] * s.wy[b], s.corner, {}};
    if (affine) u.velocity += s.turn.a * Real(a) + s.turn.b * Real(b);
    if constexpr (what != Scatter::momentum) u.sideways = s.pull.a * (s.gx[a] * s.wy[b]) + s.pull.b * (s.wx[a] * s.gy[b]) + s.pulled * u.weight;
    return u;
  }

  /// Adds what node c of the column receives.
  TALUS_HD void add(const Source& s, const Upright& u, int c, Sums& sums) const {
    const Real share = u.weight * s.wz[c] * s.mass;
    sums.mass += share;
    sums.momentum += (affine ? u.velocity + s.turn.c * Real(c) : u.velocity) * share;
    if constexpr (what != Scatter::momentum) {
      // -V tau . grad N is linear in the weights' slopes.
      const Vec3<Real> force = u.sideways * s.wz[c] + s.pull.c * (u.weight * s.gz[c]);
      if constexpr (what == Scatter::impulse) {
        sums.momentum += force;
      } else {
        sums.force += force;
      }
    }
  }

  TALUS_HD void give(int i, int j, int k, const Sums& sums) const {
    const int n = GridView<Real>::node(grid.slot(i, j), i, j, k > 0 ? k : 0);
    scatter_add(&nodes[n], sums.mass, sums.momentum);
    if constexpr (what == Scatter::force) scatter_add(&forces[n], Real(0), sums.force);
  }
};

/// Runs P2G over all points. On the CPU by groups that share no node; on the GPU by tiles of consecutive points, which mostly share their nodes.
template <class Real, class Shape, Scatter what>
void scatter_points(OnCpu place, int count, const PointGroups& groups, const ParticleToGrid<Real, Shape, what>& kernel) {
  for_each_grouped(place, count, groups, kernel);
}

#if defined(__CUDACC__)
namespace detail {
/// A warp reads 32 points, one a lane, and then takes a lane for every node: sums stay in registers for as long as the next point has the same
/// nodes, and go out by one atomic a node.
template <class Real, class Shape, Scatter what>
__global__ void scatter_tiles(int count, ParticleToGrid<Real, Shape, what> kernel) {
  using Kernel = ParticleToGrid<Real, Shape, what>;
  constexpr int warp_size = 32, nodes = Shape::width * Shape::width * Shape::width;
  constexpr int teams = warp_size / nodes, each = warp_size / teams;  // teams of lanes, and points of each
  __shared__ alignas(16) unsigned char room[tile_points * sizeof(typename Kernel::Source)];
  auto* const tile = reinterpret_cast<typename Kernel::Source*>(room);
  __shared__ bool counts[tile_points];
  const int p = static_cast<int>(blockIdx.x) * tile_points + static_cast<int>(threadIdx.x);
  counts[threadIdx.x] = p < count && kernel.counts(p);
  if (counts[threadIdx.x]) new (tile + threadIdx.x) typename Kernel::Source(kernel, p);
  __syncwarp();
  const int lane = static_cast<int>(threadIdx.x) % warp_size, team = lane / nodes, node = lane % nodes;
  if (team >= teams) return;
  const int first = static_cast<int>(threadIdx.x) / warp_size * warp_size + team * each;
  const int a = node % Shape::width, b = node / Shape::width % Shape::width, c = node / (Shape::width * Shape::width);
  typename Kernel::Sums sums;
  for (int q = first; q < first + each; ++q) {
    if (!counts[q]) continue;
    const typename Kernel::Source& s = tile[q];
    kernel.add(s, kernel.upright(s, a, b), c, sums);
    if (q + 1 < first + each && counts[q + 1] && tile[q + 1].i == s.i && tile[q + 1].j == s.j && tile[q + 1].k == s.k) continue;
    kernel.give(s.i + a, s.j + b, s.k + c, sums);
    sums = {};
  }
}
}  // namespace detail

template <class Real, class Shape, Scatter what>
void scatter_points(OnGpu, int count, const PointGroups&, const ParticleToGrid<Real, Shape, what>& kernel) {
  if (count <= 0) return;
  detail::scatter_tiles<<<(count + detail::tile_points - 1) / detail::tile_points, detail::tile_points>>>(count, kernel);
  detail::gpu_check_launch("points to grid");
}
#endif

}  // namespace talus
