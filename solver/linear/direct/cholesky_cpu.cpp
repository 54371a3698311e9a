// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "common/error.hpp"
#include "solver/linear/direct/cholesky_solver.hpp"

namespace talus {

void refuse_matrix(const std::string& what, double bytes, double limit, bool gpu) {
  constexpr double mega = 1e6;
  throw NumericalError(
      {fmt::format("[solve.implicit] linear_solver = \"cholesky\": {} {:.0f} MB", what, bytes / mega),
       fmt::format("{:.0f} MB are free {}", limit / mega, gpu ? "on the GPU" : "in memory"),
       gpu ? "Use [solve.implicit] linear_solver = \"pcg\", which assembles no matrix, a larger spacing_m, or --on cpu"
           : "Use [solve.implicit] linear_solver = \"pcg\", which assembles no matrix, or a larger spacing_m"});
}

}  // namespace talus

#if TALUS_WITH_CHOLMOD
#include <cholmod.h>
#else
#include <Eigen/SparseCholesky>
#include <new>
#endif

namespace talus {
namespace {

constexpr const char* too_large = "the factor of the matrix would take";

#if TALUS_WITH_CHOLMOD

cholmod_sparse as_cholmod(const CsrMatrix<CpuDevice>& a) {  // our rows are its columns: the matrix is symmetric
  cholmod_sparse m{};
  m.nrow = m.ncol = static_cast<std::size_t>(a.rows);
  m.nzmax = static_cast<std::size_t>(a.entries());
  m.p = const_cast<int*>(a.starts.data());
  m.i = const_cast<int*>(a.columns.data());
  m.x = const_cast<double*>(a.values.data());
  m.stype = 1;  // symmetric, of which it reads the upper triangle
  m.itype = CHOLMOD_INT;
  m.xtype = CHOLMOD_REAL;
  m.dtype = CHOLMOD_DOUBLE;
  m.sorted = m.packed = 1;
  return m;
}

/// The supernodal factor of CHOLMOD.
class CpuCholesky final : public Cholesky<CpuDevice> {
 public:
  CpuCholesky(const CpuDevice& device, double memory_limit) : device_(device), limit_(memory_limit) {
    cholmod_start(&common_);
    common_.print = 0;  // a matrix that is not positive definite is an answer, and stdout is for result paths
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.final_ll = 1;
    common_.quick_return_if_not_posdef = 1;
  }
  CpuCholesky(const CpuCholesky&) = delete;
  CpuCholesky& operator=(const CpuCholesky&) = delete;
  ~CpuCholesky() override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }

  bool solve(const CsrMatrix<CpuDevice>& a, const Buffer<double, CpuDevice>& b, Buffer<double, CpuDevice>& x) override {
    cholmod_sparse matrix = as_cholmod(a);
    if (pattern_ != a.pattern) analyse(matrix);
    pattern_ = a.pattern;
    common_.status = CHOLMOD_OK;
    cholmod_factorize(&matrix, factor_, &common_);
    if (common_.status < 0) refuse(factor_bytes(), free_memory(device_));
    if (factor_->minor < factor_->n) return false;
    cholmod_dense right{};
    right.nrow = right.d = right.nzmax = static_cast<std::size_t>(a.rows);
    right.ncol = 1;
    right.x = const_cast<double*>(b.data());
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_, &right, &common_);
    if (!solution) refuse(factor_bytes(), free_memory(device_));
    x.resize(static_cast<std::size_t>(a.rows));
    std::memcpy(x.data(), solution->x, static_cast<std::size_t>(a.rows) * sizeof(double));
    cholmod_free_dense(&solution, &common_);
    return true;
  }

  int analyses() const override { return analyses_; }
  double factor_bytes() const override { return factor_ ? 8.0 * static_cast<double>(factor_->xsize) : 0; }
  const char* name() const override { return "CHOLMOD"; }

 private:
  void analyse(cholmod_sparse& matrix) {
    ++analyses_;
    pattern_ = 0;
    cholmod_free_factor(&factor_, &common_);
    factor_ = cholmod_analyze(&matrix, &common_);
    const double needed = factor_ ? factor_bytes() : 8 * common_.lnz, free = limit_ > 0 ? limit_ : free_memory(device_);
    if (!factor_ || needed > free) refuse(needed, free);
  }

  [[noreturn]] void refuse(double needed, double free) {
    pattern_ = 0;
    cholmod_free_factor(&factor_, &common_);
    refuse_matrix(too_large, needed, free, false);
  }

  CpuDevice device_;
  double limit_;
  long pattern_ = 0;
  int analyses_ = 0;
  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
};

#else

/// The up-looking factor of Eigen, for builds without CHOLMOD.
class CpuCholesky final : public Cholesky<CpuDevice>,
                          private Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Upper> {
 public:
  CpuCholesky(const CpuDevice& device, double memory_limit) : device_(device), limit_(memory_limit) {}

  bool solve(const CsrMatrix<CpuDevice>& a, const Buffer<double, CpuDevice>& b, Buffer<double, CpuDevice>& x) override {
    const MatrixType matrix =
        Eigen::Map<const MatrixType>(a.rows, a.rows, a.entries(), a.starts.data(), a.columns.data(), a.values.data());
    try {
      if (pattern_ != a.pattern) analyse(matrix);
      pattern_ = a.pattern;
      factorize(matrix);
    } catch (const std::bad_alloc&) {
      refuse_matrix(too_large, factor_bytes(), free_memory(device_), false);
    }
    if (info() != Eigen::Success) return false;
    x.resize(static_cast<std::size_t>(a.rows));
    Eigen::Map<Eigen::VectorXd>(x.data(), a.rows) =
        SimplicialLLT::solve(Eigen::Map<const Eigen::VectorXd>(b.data(), a.rows));
    return true;
  }

  int analyses() const override { return analyses_; }
  double factor_bytes() const override { return 12.0 * static_cast<double>(m_matrix.data().allocatedSize()); }
  const char* name() const override { return "Eigen SimplicialLLT"; }

 private:
  /// Analyses the matrix. Eigen makes room for the factor here already, so that only a stated limit can refuse it.
  void analyse(const MatrixType& matrix) {
    ++analyses_;
    pattern_ = 0;
    analyzePattern(matrix);
    if (limit_ > 0 && factor_bytes() > limit_) refuse_matrix(too_large, factor_bytes(), limit_, false);
  }

  CpuDevice device_;
  double limit_;
  long pattern_ = 0;
  int analyses_ = 0;
};

#endif

}  // namespace

std::unique_ptr<Cholesky<CpuDevice>> make_cholesky(const CpuDevice& device, double memory_limit) {
  return std::make_unique<CpuCholesky>(device, memory_limit);
}

}  // namespace talus
