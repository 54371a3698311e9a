// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Deposit along the thalweg as a table.
#include <fmt/format.h>

#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace {

class ProfileWriter : public Writer {
 public:
  std::string name() const override { return "profile"; }
  std::vector<std::string_view> words() const override { return {"profile"}; }
  bool wanted(const Job& job) const override { return job.options.writes("profile"); }
  void check(const Job& job) const override {
    if (job.thalweg.line.empty())
      throw DataError({"[postprocess] outputs has \"profile\"", "the run has no thalweg: " + job.thalweg.origin,
                       "Give a line (thalweg), or leave profile out"});
  }
  std::vector<std::string> names() const override { return {"profile.csv"}; }
  Files write(const Job& job) const override {
    const RunMaps& maps = job.run.maps;
    const auto deposit = sample_along(job.thalweg, maps.grid, maps.deposit_thickness);
    std::string text = "distance_m,deposit_m\n";
    for (std::size_t i = 0; i < deposit.size(); ++i)
      text += fmt::format("{:.2f},{:.3f}\n", job.thalweg.distance[i], deposit[i]);
    return {write_file(job, "profile.csv", text)};
  }
};

}  // namespace

std::shared_ptr<Writer> profile_writer() { return std::make_shared<ProfileWriter>(); }

}  // namespace talus::postprocess
