// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/direct/cusolver.hpp"

#include <numeric>
#include <stdexcept>
#include <string>

#include <dlfcn.h>

#include "common/error.hpp"
#include "solver/linear/direct/cholesky_solver.hpp"

namespace talus {
namespace {

[[noreturn]] void missing(const std::string& why) {
  throw NumericalError(
      {"[solve.implicit] linear_solver = \"cholesky\" on a GPU: cuSOLVER cannot be used", why,
       "Install NVIDIA's libcusolver (part of the CUDA Toolkit), or use linear_solver = \"pcg\", or --on cpu"});
}

void* open_library() {
  std::string why;
  for (const char* name :
       {"libcusolver.so.12", "libcusolver.so.11", "libcusolver.so", "/usr/local/cuda/lib64/libcusolver.so"}) {
    if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
    if (why.empty()) why = dlerror();
  }
  missing(why);
}

/// A function of cuSOLVER or of the cuSPARSE it brings along.
template <class Function>
void load(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function) missing(std::string(name) + " is not in the library");
}

Cusolver load_all() {
  void* library = open_library();  // stays open as long as the program runs
  Cusolver c;
  load(library, "cusolverSpCreate", c.create);
  load(library, "cusolverSpDestroy", c.destroy);
  load(library, "cusolverSpSetStream", c.set_stream);
  load(library, "cusparseCreateMatDescr", c.create_descriptor);
  load(library, "cusparseDestroyMatDescr", c.destroy_descriptor);
  load(library, "cusolverSpCreateCsrcholInfo", c.create_info);
  load(library, "cusolverSpDestroyCsrcholInfo", c.destroy_info);
  load(library, "cusolverSpXcsrmetisndHost", c.order_by_dissection);
  load(library, "cusolverSpXcsrsymamdHost", c.order_by_degree);
  load(library, "cusolverSpXcsrcholAnalysis", c.analyse);
  load(library, "cusolverSpDcsrcholBufferInfo", c.sizes);
  load(library, "cusolverSpDcsrcholFactor", c.factorise);
  load(library, "cusolverSpDcsrcholZeroPivot", c.zero_pivot);
  load(library, "cusolverSpDcsrcholSolve", c.solve);
  return c;
}

/// The factor of cuSOLVER, of the matrix renumbered by nested dissection, on the device's stream.
class GpuCholesky final : public Cholesky<GpuDevice> {
 public:
  GpuCholesky(const GpuDevice& device, double memory_limit) : device_(device), limit_(memory_limit) {}
  GpuCholesky(const GpuCholesky&) = delete;
  GpuCholesky& operator=(const GpuCholesky&) = delete;
  ~GpuCholesky() override {
    detail::gpu_select(device_);
    forget();
    if (descriptor_) cusolver().destroy_descriptor(descriptor_);
    if (handle_) cusolver().destroy(handle_);
  }

  bool solve(const CsrMatrix<GpuDevice>& a, const Buffer<double, GpuDevice>& b, Buffer<double, GpuDevice>& x) override {
    detail::gpu_select(device_);
    if (!handle_) {
      check(cusolver().create(&handle_), "cusolverSpCreate");
      check(cusolver().set_stream(handle_, device_.stream()), "cusolverSpSetStream");
    }
    if (!descriptor_) check(cusolver().create_descriptor(&descriptor_), "cusparseCreateMatDescr");
    if (pattern_ != a.pattern) analyse(a);
    if (!factorise(a)) return false;
    for (auto* v : {&right_, &solution_, &x}) v->resize(static_cast<std::size_t>(a.rows));
    matrix_.to_order(b, right_, a.rows);
    check(cusolver().solve(handle_, a.rows, right_.data(), solution_.data(), info_, workspace_.data()),
          "cusolverSpDcsrcholSolve");
    matrix_.from_order(solution_, x, a.rows);
    return true;
  }

  int analyses() const override { return analyses_; }
  double factor_bytes() const override { return held_; }
  const char* name() const override { return "cuSOLVER"; }

 private:
  void check(int status, const char* what) const {
    if (status == Cusolver::out_of_memory) {
      const double free = free_memory(device_);
      refuse_matrix(std::string(what) + " needs more than", free, free, true);
    }
    if (status != 0)
      throw std::runtime_error(std::string("cuSOLVER: ") + what + " failed with status " + std::to_string(status));
  }

  /// The factor itself lives in info_.
  void forget() {
    if (info_) cusolver().destroy_info(info_);
    info_ = nullptr;
    pattern_ = 0;
    held_ = 0;
  }

  std::vector<int> order_nodes(const HostPattern& graph) const {
    const int nodes = static_cast<int>(graph.starts.size()) - 1, entries = static_cast<int>(graph.columns.size());
    std::vector<int> found(static_cast<std::size_t>(nodes));
    std::iota(found.begin(), found.end(), 0);
    if (nodes < 3) return found;  // nothing to gain
    const Cusolver& c = cusolver();
    const int* starts = graph.starts.data();
    const int* columns = graph.columns.data();
    if (c.order_by_dissection(handle_, nodes, entries, descriptor_, starts, columns, nullptr, found.data()) != 0) {
      check(c.order_by_degree(handle_, nodes, entries, descriptor_, starts, columns, found.data()),
            "cusolverSpXcsrsymamdHost");
    }
    return found;
  }

  void renumber_matrix(const CsrMatrix<GpuDevice>& a) {
    const HostPattern host{a.starts.download(), a.columns.download()};
    matrix_.take(host, order_nodes(graph_of_nodes(host)));
    matrix_.fill(a);
  }

  void analyse(const CsrMatrix<GpuDevice>& a) {
    ++analyses_;
    forget();
    renumber_matrix(a);
    synchronise(device_);  // what cuSOLVER reads is there, whatever streams it uses within
    const Cusolver& c = cusolver();
    check(c.create_info(&info_), "cusolverSpCreateCsrcholInfo");
    check(c.analyse(handle_, a.rows, a.entries(), descriptor_, matrix_.starts(), matrix_.columns(), info_),
          "cusolverSpXcsrcholAnalysis");
    std::size_t internal = 0, scratch = 0;
    check(c.sizes(handle_, a.rows, a.entries(), descriptor_, matrix_.values(), matrix_.starts(), matrix_.columns(),
                  info_, &internal, &scratch),
          "cusolverSpDcsrcholBufferInfo");
    held_ = static_cast<double>(internal) + static_cast<double>(scratch);
    const double free = limit_ > 0 ? limit_ : free_memory(device_) + static_cast<double>(workspace_.bytes());
    if (held_ > free) refuse(free);
    workspace_.resize(scratch);
    pattern_ = a.pattern;
  }

  bool factorise(const CsrMatrix<GpuDevice>& a) {
    matrix_.fill(a);
    synchronise(device_);
    const Cusolver& c = cusolver();
    const int status = c.factorise(handle_, a.rows, a.entries(), descriptor_, matrix_.values(), matrix_.starts(),
                                   matrix_.columns(), info_, workspace_.data());
    if (status == Cusolver::out_of_memory) refuse(free_memory(device_));
    check(status, "cusolverSpDcsrcholFactor");
    int pivot = -1;
    check(c.zero_pivot(handle_, info_, 0.0, &pivot), "cusolverSpDcsrcholZeroPivot");
    return pivot < 0;
  }

  [[noreturn]] void refuse(double free) {
    const double needed = held_;
    forget();
    refuse_matrix("the factor of the matrix would take", needed, free, true);
  }

  GpuDevice device_;
  double limit_, held_ = 0;  // [bytes]
  long pattern_ = 0;
  int analyses_ = 0;
  Cusolver::Handle handle_ = nullptr;
  Cusolver::Descriptor descriptor_ = nullptr;  // as made: a general matrix, indices from 0
  Cusolver::Info info_ = nullptr;
  RenumberedMatrix<GpuDevice> matrix_{device_};
  Buffer<double, GpuDevice> right_{device_}, solution_{device_};
  Buffer<unsigned char, GpuDevice> workspace_{device_};
};

}  // namespace

const Cusolver& cusolver() {
  static const Cusolver library = load_all();
  return library;
}

std::unique_ptr<Cholesky<GpuDevice>> make_cholesky(const GpuDevice& device, double memory_limit) {
  return std::make_unique<GpuCholesky>(device, memory_limit);
}

}  // namespace talus
