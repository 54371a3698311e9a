// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "common/error.hpp"
#include "solver/linear/direct/cholesky.hpp"

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
