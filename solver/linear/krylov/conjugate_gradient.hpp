// Preconditioned conjugate gradients (Hestenes & Stiefel 1952). Step lengths and the end of the loop are found where
// the vectors are: the host only looks, now and then, whether it is over.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/parallel/recording.hpp"
#include "solver/parallel/sums.hpp"
#include "solver/parallel/vectors.hpp"

namespace talus {

struct LinearReport {
  int iterations = 0;
  double residual = 0;  // |b - A x| / |b|
  bool converged = false;
  bool indefinite = false;  // met a direction of negative curvature: the tangent is no minimum's
};

/// Where a solve stands, kept beside the vectors.
struct CgState {
  enum Halt : int { no, converged, indefinite, spent };
  double tolerance = 0;
  int most = 0, iterations = 0;
  Halt halt = no;
  double size = 0;       // b . b
  double residual = 0;   // r . r
  double curvature = 0;  // p . A p
  double angle = 0;      // r . z
  double turn = 0;       // share of the last direction in the next

  TALUS_HD void begin(double b_b) {
    size = residual = b_b;
    if (!(b_b > 0)) halt = b_b == 0 ? converged : spent;
  }
  TALUS_HD void take_curvature(double p_ap) {
    curvature = p_ap;
    if (!(p_ap > 0)) halt = indefinite;
  }
  TALUS_HD void take_residual(double r_r) {
    residual = r_r;
    ++iterations;
    if (sqrt(r_r / size) <= tolerance) {
      halt = converged;
    } else if (iterations >= most) {
      halt = spent;
    }
  }
  TALUS_HD void take_angle(double r_z) {
    turn = iterations > 0 ? r_z / angle : 0;
    angle = r_z;
  }
};

namespace detail {

/// What becomes of each sum.
struct FinishBegin {
  CgState* state;
  TALUS_HD void operator()(const double* total) const { state->begin(*total); }
};
struct FinishCurvature {
  CgState* state;
  TALUS_HD void operator()(const double* total) const {
    if (state->halt == CgState::no) state->take_curvature(*total);
  }
};
struct FinishResidual {
  CgState* state;
  TALUS_HD void operator()(const double* total) const {
    if (state->halt == CgState::no) state->take_residual(*total);
  }
};
struct FinishResidualAndAngle {
  CgState* state;
  TALUS_HD void operator()(const double* total) const {
    if (state->halt == CgState::no) state->take_residual(total[0]);
    if (state->halt == CgState::no) state->take_angle(total[1]);
  }
};
struct FinishAngle {
  CgState* state;
  TALUS_HD void operator()(const double* total) const {
    if (state->halt == CgState::no) state->take_angle(*total);
  }
};

struct BeginCg {
  const Vec3<double>* b;
  Vec3<double>*x, *r, *z, *p, *ap;
  double bytes(int count) const { return 6.0 * count * sizeof(Vec3<double>); }
  TALUS_HD Terms<1> operator()(int n) const {
    x[n] = z[n] = p[n] = ap[n] = {};
    r[n] = b[n];
    return {{dot(b[n], b[n])}};
  }
};

template <class Close>
struct CloseProductOf {
  using Named = Close;
  double bytes(int count) const { return kernel_bytes(close, count) + count * static_cast<double>(sizeof(*p)); }
  Close close;
  const CgState* state;
  const Vec3<double>*p, *ap;
  TALUS_HD Terms<1> operator()(int n) const {
    if (state->halt != CgState::no) return {};
    close(n);
    return {{dot(p[n], ap[n])}};
  }
};

/// A node's part of the step along p, while the loop goes on. Returns its share of r . r.
struct StepAlong {
  CgState* state;
  const Vec3<double>*p, *ap;
  Vec3<double>*x, *r;
  double bytes(int count) const { return 6.0 * count * sizeof(Vec3<double>); }
  TALUS_HD double operator()(int n) const {
    const double alpha = state->angle / state->curvature;
    x[n] += p[n] * alpha;
    const Vec3<double> rest = r[n] - ap[n] * alpha;
    r[n] = rest;
    return dot(rest, rest);
  }
};

struct TurnDirection {
  const CgState* state;
  const Vec3<double>* z;
  Vec3<double>*p, *ap;
  double bytes(int count) const { return 4.0 * count * sizeof(Vec3<double>); }
  TALUS_HD void operator()(int n) const {
    ap[n] = {};
    if (state->halt == CgState::no) p[n] = z[n] + p[n] * state->turn;
  }
};

}  // namespace detail

template <class Device>
class ConjugateGradient {
 public:
  /// Solves A x = b from x = 0. `system` has four members: product(p, ap, state), which adds to ap what takes more than
  /// one node and may do nothing once `state` has halted; close(p, ap), a kernel over the nodes that completes ap;
  /// precondition(r, z, state), which leaves z and r . z (detail::FinishAngle); precondition_after(step, r, z, state),
  /// which does the same after detail::StepAlong, and leaves r . r too.
  template <class System>
  LinearReport solve(const NodeVector<Device>& b, NodeVector<Device>& x, double tolerance, int most, System&& system) {
    const int count = static_cast<int>(b.size());
    for (auto* v : {&x, &r_, &z_, &p_, &ap_}) v->resize(b.size());
    CgState state;
    state.tolerance = tolerance;
    state.most = most;
    state_.upload({state});
    CgState* const s = state_.data();
    sum_each<1>(Device{}, count, sums_,
                detail::BeginCg{b.data(), x.data(), r_.data(), z_.data(), p_.data(), ap_.data()},
                detail::FinishBegin{s});
    system.precondition(r_, z_, s);
    // As many as the last solve took, then a few at a time: what is started after the end does nothing but take its
    // time.
    loop_.forget();
    int ahead = Device::is_gpu ? std::clamp(last_, 2, 64) : 1;
    for (;;) {
      loop_.repeat(ahead, [&] {
        for_each(Device{}, count, detail::TurnDirection{s, z_.data(), p_.data(), ap_.data()});
        system.product(p_, ap_, s);
        sum_each<1>(Device{}, count, sums_, close_product(system.close(p_, ap_)), detail::FinishCurvature{s});
        system.precondition_after(detail::StepAlong{s, p_.data(), ap_.data(), x.data(), r_.data()}, r_, z_, s);
      });
      state = state_.download().front();
      if (state.halt != CgState::no) break;
      ahead = Device::is_gpu ? std::max(2, ahead / 4) : 1;
    }
    last_ = state.iterations;
    LinearReport report;
    report.iterations = state.iterations;
    report.residual = state.size > 0 ? std::sqrt(state.residual / state.size) : 0;
    report.converged = state.halt == CgState::converged;
    report.indefinite = state.halt == CgState::indefinite;
    return report;
  }

  std::size_t bytes() const { return r_.bytes() + z_.bytes() + p_.bytes() + ap_.bytes() + sums_.bytes(); }

 private:
  template <class Close>
  detail::CloseProductOf<Close> close_product(const Close& close) {
    return {close, state_.data(), p_.data(), ap_.data()};
  }

  NodeVector<Device> r_, z_, p_, ap_;
  Buffer<CgState, Device> state_;
  SumSpace<Device> sums_;
  Recording<Device> loop_;
  int last_ = 0;
};

}  // namespace talus
