// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors and matrices of three, small enough to live in registers; the same on both devices.
#pragma once

#include <cmath>
#include <type_traits>

#include "solver/parallel/macros.hpp"

namespace talus {

/// A vector of three components.
template <class Real>
struct Vec3 {
  Real x{}, y{}, z{};
  TALUS_HD Vec3 operator+(const Vec3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  TALUS_HD Vec3 operator-(const Vec3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  TALUS_HD Vec3 operator*(Real s) const { return {x * s, y * s, z * s}; }
  TALUS_HD Vec3& operator+=(const Vec3& o) {
    x += o.x;
    y += o.y;
    z += o.z;
    return *this;
  }
};

/// The scalar product a . b.
template <class Real>
TALUS_HD Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// The length |a|.
template <class Real>
TALUS_HD Real length(const Vec3<Real>& a) {
  return Real(sqrt(dot(a, a)));
}

/// A vector of four numbers loaded and stored at once: a node's mass and momentum.
template <class Real>
struct alignas(4 * sizeof(Real)) Vec4 {
  Real w{}, x{}, y{}, z{};
};

/// The four numbers of a Vec4 to compute with. A CPU has them in its vector registers, whose 16 bytes every x86-64 and
/// AArch64 has; a GPU leaves out the parts that nobody reads.
template <class Real>
class Four {
 public:
  TALUS_HD Four() = default;
#if TALUS_ON_CPU == 1
  TALUS_HD Four(Real w, const Vec3<Real>& v) : low_{w, v.x}, high_{v.y, v.z} {}
  TALUS_HD explicit Four(const Vec4<Real>& v) : low_{v.w, v.x}, high_{v.y, v.z} {}
  TALUS_HD Four& operator+=(const Four& o) {
    low_ += o.low_;
    high_ += o.high_;
    return *this;
  }
  TALUS_HD Four operator+(const Four& o) const {
    Four sum(*this);
    return sum += o;
  }
  TALUS_HD Four operator*(Real s) const {
    Four scaled(*this);
    scaled.low_ *= s;
    scaled.high_ *= s;
    return scaled;
  }
  TALUS_HD void store(Vec4<Real>& to) const { to = {low_[0], low_[1], high_[0], high_[1]}; }
  TALUS_HD Real w() const { return low_[0]; }
  TALUS_HD Vec3<Real> xyz() const { return {low_[1], high_[0], high_[1]}; }

 private:
  using Doubles = double __attribute__((vector_size(2 * sizeof(double))));
  using Floats = float __attribute__((vector_size(2 * sizeof(float))));
  std::conditional_t<sizeof(Real) == sizeof(double), Doubles, Floats> low_{}, high_{};
#else
  TALUS_HD Four(Real w, const Vec3<Real>& v) : w_(w), xyz_(v) {}
  TALUS_HD explicit Four(const Vec4<Real>& v) : w_(v.w), xyz_{v.x, v.y, v.z} {}
  TALUS_HD Four& operator+=(const Four& o) {
    w_ += o.w_;
    xyz_ += o.xyz_;
    return *this;
  }
  TALUS_HD Four operator+(const Four& o) const { return {w_ + o.w_, xyz_ + o.xyz_}; }
  TALUS_HD Four operator*(Real s) const { return {w_ * s, xyz_ * s}; }
  TALUS_HD Real w() const { return w_; }
  TALUS_HD Vec3<Real> xyz() const { return xyz_; }

 private:
  Real w_{};
  Vec3<Real> xyz_;
#endif
};

/// The vector in double precision.
template <class Real>
TALUS_HD Vec3<double> widen(const Vec3<Real>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
/// The vector rounded to `Real`.
template <class Real>
TALUS_HD Vec3<Real> narrow(const Vec3<double>& v) {
  return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

/// A full matrix; columns are vectors, so that column b of a gradient is the derivative along b.
template <class Real>
struct Mat3 {
  Vec3<Real> a, b, c;
  TALUS_HD Vec3<Real> operator*(const Vec3<Real>& v) const { return a * v.x + b * v.y + c * v.z; }
};

/// This function adds v g^T to m.
template <class Real>
TALUS_HD void add_outer(Mat3<Real>& m, const Vec3<Real>& v, const Vec3<Real>& g) {
  m.a += v * g.x;
  m.b += v * g.y;
  m.c += v * g.z;
}

/// The determinant of m.
template <class Real>
TALUS_HD Real determinant(const Mat3<Real>& m) {
  return m.a.x * (m.b.y * m.c.z - m.b.z * m.c.y) - m.b.x * (m.a.y * m.c.z - m.a.z * m.c.y) +
         m.c.x * (m.a.y * m.b.z - m.a.z * m.b.y);
}

/// The vector product u x v.
template <class Real>
TALUS_HD Vec3<Real> cross(const Vec3<Real>& u, const Vec3<Real>& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

/// The inverse of a matrix that is not singular, by cofactors.
template <class Real>
TALUS_HD Mat3<Real> inverted(const Mat3<Real>& m) {
  const Real s = Real(1) / determinant(m);
  // Rows of the inverse are the cross products of the columns.
  const Vec3<Real> ra = cross(m.b, m.c) * s, rb = cross(m.c, m.a) * s, rc = cross(m.a, m.b) * s;
  return {{ra.x, rb.x, rc.x}, {ra.y, rb.y, rc.y}, {ra.z, rb.z, rc.z}};
}

/// A symmetric matrix by its six entries.
template <class Real>
struct Sym3 {
  Real xx{}, yy{}, zz{}, xy{}, yz{}, xz{};
  TALUS_HD Sym3 operator+(const Sym3& o) const {
    return {xx + o.xx, yy + o.yy, zz + o.zz, xy + o.xy, yz + o.yz, xz + o.xz};
  }
  TALUS_HD Sym3 operator*(Real s) const { return {xx * s, yy * s, zz * s, xy * s, yz * s, xz * s}; }
  /// The sum of this matrix and s I.
  TALUS_HD Sym3 plus_identity(Real s) const { return {xx + s, yy + s, zz + s, xy, yz, xz}; }
  TALUS_HD Vec3<Real> operator*(const Vec3<Real>& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

/// The trace of s.
template <class Real>
TALUS_HD Real trace(const Sym3<Real>& s) {
  return s.xx + s.yy + s.zz;
}
/// The deviator of s: s less a third of its trace on the diagonal.
template <class Real>
TALUS_HD Sym3<Real> deviator(const Sym3<Real>& s) {
  return s.plus_identity(-trace(s) / Real(3));
}
/// The product s : s, the square of the Frobenius norm.
template <class Real>
TALUS_HD Real norm_squared(const Sym3<Real>& s) {
  return s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + Real(2) * (s.xy * s.xy + s.yz * s.yz + s.xz * s.xz);
}
/// The product of two symmetric matrices that commute (powers of one matrix), which is symmetric.
template <class Real>
TALUS_HD Sym3<Real> commuting_product(const Sym3<Real>& s, const Sym3<Real>& t) {
  return {s.xx * t.xx + s.xy * t.xy + s.xz * t.xz, s.xy * t.xy + s.yy * t.yy + s.yz * t.yz,
          s.xz * t.xz + s.yz * t.yz + s.zz * t.zz, s.xx * t.xy + s.xy * t.yy + s.xz * t.yz,
          s.xy * t.xz + s.yy * t.yz + s.yz * t.zz, s.xx * t.xz + s.xy * t.yz + s.xz * t.zz};
}

/// The inverse of a symmetric matrix that is not singular, by cofactors.
template <class Real>
TALUS_HD Sym3<Real> inverted(const Sym3<Real>& s) {
  const Real xx = s.yy * s.zz - s.yz * s.yz, xy = s.yz * s.xz - s.xy * s.zz, xz = s.xy * s.yz - s.yy * s.xz;
  const Real scale = Real(1) / (s.xx * xx + s.xy * xy + s.xz * xz);
  return Sym3<Real>{xx, s.xx * s.zz - s.xz * s.xz, s.xx * s.yy - s.xy * s.xy, xy, s.xy * s.xz - s.xx * s.yz, xz} *
         scale;
}

/// A unit vector along the eigenvector of s whose eigenvalue lies furthest from the other two, good to the square root
/// of rounding (Eberly 2014, A robust eigensolver for 3 x 3 symmetric matrices); zero where s is a multiple of the
/// identity.
template <class Real>
TALUS_HD Vec3<Real> outlying_eigenvector(const Sym3<Real>& s) {
  const Real mean = trace(s) / Real(3);
  const Sym3<Real> off = s.plus_identity(-mean);
  const Real size = Real(sqrt(norm_squared(off) / Real(6)));
  if (!(size > fabs(mean) * Real(sizeof(Real) == 8 ? 1e-14 : 1e-6))) return {};
  const Sym3<Real> b = off * (Real(1) / size);  // eigenvalues 2 cos of angles a third of a turn apart
  const Real half = Real(0.5) * determinant(Mat3<Real>{{b.xx, b.xy, b.xz}, {b.xy, b.yy, b.yz}, {b.xz, b.yz, b.zz}});
  const Real r = half > Real(1) ? Real(1) : half < Real(-1) ? Real(-1) : half;
  const Real value = Real(r >= Real(0) ? Real(2) * cos(acos(r) / Real(3)) : Real(-2) * cos(acos(-r) / Real(3)));
  const Vec3<Real> rows[3] = {{b.xx - value, b.xy, b.xz}, {b.xy, b.yy - value, b.yz}, {b.xz, b.yz, b.zz - value}};
  Vec3<Real> best{};
  Real most = 0;
  for (int p = 0; p < 3; ++p) {
    const Vec3<Real> c = cross(rows[p], rows[(p + 1) % 3]);
    const Real square = dot(c, c);
    if (square > most) {
      most = square;
      best = c;
    }
  }
  return most > Real(0) ? best * Real(Real(1) / sqrt(most)) : Vec3<Real>{};
}

/// This function finds the eigenvalues of s, and its eigenvectors as the columns of `vectors`, by cyclic Jacobi
/// rotations (Golub & Van Loan 2013, section 8.5): accurate for nearly equal eigenvalues too. They begin in axes of
/// which one is an eigenvector but for rounding, so that one sweep does nearly always.
template <class Real>
TALUS_HD void eigen_symmetric(const Sym3<Real>& s, Real values[3], Mat3<Real>& vectors) {
  Real m[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  Real v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Vec3<Real> w = outlying_eigenvector(s);
  if (dot(w, w) > Real(0)) {
    const Vec3<Real> across = fabs(w.x) > fabs(w.y) ? Vec3<Real>{-w.z, Real(0), w.x} : Vec3<Real>{Real(0), w.z, -w.y};
    const Vec3<Real> u = across * (Real(1) / length(across)), t = cross(w, u);
    const Vec3<Real> axis[3] = {u, t, w};
    for (int q = 0; q < 3; ++q) {
      const Vec3<Real> image = s * axis[q];
      for (int p = 0; p <= q; ++p) m[p][q] = m[q][p] = dot(axis[p], image);
      v[0][q] = axis[q].x;
      v[1][q] = axis[q].y;
      v[2][q] = axis[q].z;
    }
  }
  for (int sweep = 0; sweep < 12; ++sweep) {
    const Real off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
    const Real all = m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2];
    if (off <= all * Real(sizeof(Real) == 8 ? 1e-33 : 1e-15) || off == Real(0)) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (m[p][q] == Real(0)) continue;
        const Real theta = (m[q][q] - m[p][p]) / (Real(2) * m[p][q]);
        const Real t = Real((theta >= 0 ? Real(1) : Real(-1)) / (fabs(theta) + sqrt(theta * theta + Real(1))));
        const Real c = Real(Real(1) / sqrt(t * t + Real(1)));
        const Real sn = t * c;
        for (auto& row : m) {
          const Real kp = row[p], kq = row[q];
          row[p] = c * kp - sn * kq;
          row[q] = sn * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const Real pk = m[p][k], qk = m[q][k];
          m[p][k] = c * pk - sn * qk;
          m[q][k] = sn * pk + c * qk;
          const Real vp = v[k][p], vq = v[k][q];
          v[k][p] = c * vp - sn * vq;
          v[k][q] = sn * vp + c * vq;
        }
      }
    }
  }
  for (int k = 0; k < 3; ++k) values[k] = m[k][k];
  vectors = {{v[0][0], v[1][0], v[2][0]}, {v[0][1], v[1][1], v[2][1]}, {v[0][2], v[1][2], v[2][2]}};
}

/// The sum of values[k] n_k n_k^T over the columns n_k of `vectors`.
template <class Real>
TALUS_HD Sym3<Real> compose(const Real values[3], const Mat3<Real>& n) {
  const auto outer = [](const Vec3<Real>& u, Real s) {
    return Sym3<Real>{u.x * u.x * s, u.y * u.y * s, u.z * u.z * s, u.x * u.y * s, u.y * u.z * s, u.x * u.z * s};
  };
  return outer(n.a, values[0]) + outer(n.b, values[1]) + outer(n.c, values[2]);
}

}  // namespace talus
