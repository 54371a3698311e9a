// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Deposit along the thalweg as a table.
#include <fmt/format.h>

#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

void check(const Job& job) {
  if (job.thalweg.line.empty())
    throw DataError({"[postprocess] outputs has \"profile\"", "the run has no thalweg: " + job.thalweg.origin,
                     "Give a line (thalweg), or leave profile out"});
}

Files write(const Job& job) {
  const auto deposit = sample_along(job.thalweg, job.run.maps.grid, job.run.maps.deposit_thickness);
  std::string text = "distance_m,deposit_m\n";
  for (std::size_t i = 0; i < deposit.size(); ++i)
    text += fmt::format("{:.2f},{:.3f}\n", job.thalweg.distance[i], deposit[i]);
  return {write_file(job, "profile.csv", text)};
}

}  // namespace

Writer profile_writer() {
  return {.name = "profile", .names = {"profile.csv"}, .write = write, .words = {"profile"}, .check = check};
}

}  // namespace talus::postprocess
