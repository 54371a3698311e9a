// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/elements/mean_dilation.hpp"

#include "solver/elements/forces.hpp"
#include "solver/grid/instances.hpp"

namespace talus::solver {
namespace {

/// One thread: one element. Its number goes to its points.
struct NumberPoints {
  ElementView elements;
  int* element_of;
  TALUS_HD void operator()(int e) const {
    for (int s = elements.starts[e]; s < elements.starts[e + 1]; ++s) element_of[elements.order[s]] = e;
  }
};

/// One thread: one element. Its means (T17b): of the volume change, the stress, the bulk response and the gradients.
template <class Real, class Shape, class Laws>
struct MeasureMeans {
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real, Laws> materials;
  bool dilatant;
  ElementView elements;
  const Vec3<double>* u;
  Real duration;
  Real* increment;
  Real* stress;
  Real* stiffness;
  Vec3<Real>* gradient;

  TALUS_HD void operator()(int e) const {
    constexpr int w = Shape::width, nodes = w * w * w;
    Real volume = 0, dilation = 0;
    Vec3<Real> b[static_cast<std::size_t>(nodes)] = {};
    for (int s = elements.starts[e]; s < elements.starts[e + 1]; ++s) {
      const int p = elements.order[s];
      const PointGradients<Real, Shape> g(grid, points, p);
      const Mat3<Real> change = displacement_gradient(grid, g, u);
      const Real v = points.volume[p];
      volume += v;
      dilation += v * log_volume_change(change);
      // d ln det(I + G) = trace(dG F^-1): the gradients pulled back, F^-T grad N.
      const Mat3<Real> pull = inverted(Mat3<Real>{{change.a.x + 1, change.a.y, change.a.z},
                                                  {change.b.x, change.b.y + 1, change.b.z},
                                                  {change.c.x, change.c.y, change.c.z + 1}});
      for (int n = 0; n < nodes; ++n) {
        const Vec3<Real> grad = g.gradient(n / w % w, n / (w * w), n % w);
        b[n] += Vec3<Real>{dot(pull.a, grad), dot(pull.b, grad), dot(pull.c, grad)} * v;
      }
    }
    for (int n = 0; n < nodes; ++n)
      gradient[static_cast<std::size_t>(e) * nodes + static_cast<std::size_t>(n)] = b[n] * (1 / volume);
    increment[e] = dilation / volume;
    Real mean = 0, bulk = 0;
    for (int s = elements.starts[e]; s < elements.starts[e + 1]; ++s) {
      const int p = elements.order[s];
      const PointGradients<Real, Shape> g(grid, points, p);
      const VolumeResponse<Real> r = volume_response(materials.of(points, p), state_of(points, p, dilatant),
                                                     displacement_gradient(grid, g, u), duration, increment[e]);
      mean += points.volume[p] * r.stress;
      bulk += points.volume[p] * r.bulk;
    }
    stress[e] = mean / volume;
    stiffness[e] = bulk;
  }
};

/// One thread: one element. It adds kappa V b (b . x) to y.
template <class Real, int nodes>
struct ApplyMeans {
  ElementView elements;
  MeanDilationView<Real> means;
  const Vec3<double>* x;
  Vec3<double>* y;
  TALUS_HD void operator()(int e) const {
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    const Vec3<Real>* b = means.gradient + static_cast<std::size_t>(e) * nodes;
    double along = 0;
    for (int n = 0; n < nodes; ++n) along += dot(widen(b[n]), x[mine[n]]);
    along *= static_cast<double>(means.stiffness[e]);
    for (int n = 0; n < nodes; ++n) scatter_add(&y[mine[n]], widen(b[n]) * along);
  }
};

template <class Real, int nodes>
struct AddMeanBlocks {
  ElementView elements;
  MeanDilationView<Real> means;
  Sym3<double>* blocks;
  TALUS_HD void operator()(int e) const {
    const int* mine = elements.nodes + static_cast<std::size_t>(e) * nodes;
    const double k = static_cast<double>(means.stiffness[e]);
    for (int n = 0; n < nodes; ++n) {
      const Vec3<double> b = widen(means.gradient[static_cast<std::size_t>(e) * nodes + static_cast<std::size_t>(n)]);
      Sym3<double>& block = blocks[mine[n]];
      talus::scatter_add(&block.xx, k * b.x * b.x);
      talus::scatter_add(&block.yy, k * b.y * b.y);
      talus::scatter_add(&block.zz, k * b.z * b.z);
      talus::scatter_add(&block.xy, k * b.x * b.y);
      talus::scatter_add(&block.yz, k * b.y * b.z);
      talus::scatter_add(&block.xz, k * b.x * b.z);
    }
  }
};

}  // namespace

template <class Real, class Device, class Shape>
void MeanDilation<Real, Device, Shape>::begin_step(const ElementList<Real, Device, Shape>& list, int points) {
  const auto count = static_cast<std::size_t>(list.count());
  element_of_.resize(static_cast<std::size_t>(points));
  for (auto* buffer : {&increment_, &stress_, &stiffness_}) buffer->resize(count);
  gradient_.resize(count * nodes_each);
  for_each(list.device(), list.count(), NumberPoints{list.view(), element_of_.data()});
}

template <class Real, class Device, class Shape>
void MeanDilation<Real, Device, Shape>::measure(const ElementList<Real, Device, Shape>& list,
                                                const GridView<Real>& grid, const ParticleView<Real>& points,
                                                const Materials<Real>& materials, const Motion& motion) {
  with_laws_of(materials, [&]<class Laws>(const Materials<Real, Laws>& known) {
    for_each(list.device(), list.count(),
             MeasureMeans<Real, Shape, Laws>{grid, points, known, motion.dilatant, list.view(), motion.u,
                                             static_cast<Real>(motion.duration), increment_.data(), stress_.data(),
                                             stiffness_.data(), gradient_.data()});
  });
}

template <class Real, class Device, class Shape>
void apply_means(const ElementList<Real, Device, Shape>& list, const MeanDilationView<Real>& means,
                 const NodeVector<Device>& x, NodeVector<Device>& y) {
  constexpr int nodes = ElementList<Real, Device, Shape>::nodes_each;
  for_each_grouped(list.device(), list.count(), list.groups(),
                   ApplyMeans<Real, nodes>{list.view(), means, x.data(), y.data()});
}

template <class Real, class Device, class Shape>
void add_mean_blocks(const ElementList<Real, Device, Shape>& list, const MeanDilationView<Real>& means,
                     Buffer<Sym3<double>, Device>& blocks) {
  constexpr int nodes = ElementList<Real, Device, Shape>::nodes_each;
  for_each_grouped(list.device(), list.count(), list.groups(),
                   AddMeanBlocks<Real, nodes>{list.view(), means, blocks.data()});
}

#define TALUS_INSTANTIATE(Real, Device, Shape)                                                          \
  template class MeanDilation<Real, Device, Shape>;                                                     \
  template void apply_means(const ElementList<Real, Device, Shape>&, const MeanDilationView<Real>&,     \
                            const NodeVector<Device>&, NodeVector<Device>&);                            \
  template void add_mean_blocks(const ElementList<Real, Device, Shape>&, const MeanDilationView<Real>&, \
                                Buffer<Sym3<double>, Device>&);
TALUS_FOR_EACH_INSTANCE(TALUS_INSTANTIATE)
#undef TALUS_INSTANTIATE

}  // namespace talus::solver
