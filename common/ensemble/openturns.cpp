// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/openturns.hpp"

#include <dlfcn.h>

#include "common/error.hpp"

namespace talus::openturns {
namespace {

const Library* load() {
  using Make = const Library*();
  // The dynamic linker looks where it looks for the libraries of what calls: beside them, then in the system's folders.
  void* const module = ::dlopen("libtalus-openturns.so", RTLD_NOW | RTLD_LOCAL);
  auto* const make = module == nullptr ? nullptr : reinterpret_cast<Make*>(::dlsym(module, "talus_openturns"));
  if (make != nullptr) return make();
  const char* const why = ::dlerror();
  throw DataError({"libtalus-openturns.so, which draws the members of ensembles, cannot be loaded",
                   why == nullptr ? "the dynamic linker does not say why" : why,
                   "Install Talus again; what it needs of OpenTURNS comes with Debian's libopenturns-dev"});
}

}  // namespace

const Library& library() {
  static const Library* const loaded = load();
  return *loaded;
}

}  // namespace talus::openturns
