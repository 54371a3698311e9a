// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linear/direct/cusolver.hpp"

#include <dlfcn.h>

#include <string>

#include "common/error.hpp"

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

}  // namespace

const Cusolver& cusolver() {
  static const Cusolver library = load_all();
  return library;
}

}  // namespace talus
