// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/profile_report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace talus::solver {
namespace {

std::vector<Profile::Kernel> by_time(const Profile& profile) {
  std::vector<Profile::Kernel> kernels = profile.kernels();
  std::stable_sort(kernels.begin(), kernels.end(), [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
  return kernels;
}

double rate(const Profile::Kernel& k) { return k.seconds > 0 ? k.bytes / k.seconds : 0; }

}  // namespace

std::vector<std::string> profile_lines(const RunSummary& summary, const Profile& profile, double copy) {
  std::vector<std::string> lines;
  const auto line = [&](const std::string& name, double seconds) {
    lines.push_back(fmt::format("  {:28} {:9.3f} s {:5.1f} %", name, seconds,
                                summary.wall_time > 0 ? 100 * seconds / summary.wall_time : 0));
  };
  lines.push_back("where the time went:");
  double named = 0;
  for (const auto& [name, seconds] : summary.profile) {
    if (!(seconds > 0)) continue;
    named += seconds;
    line(name, seconds);
  }
  line("everything else", summary.wall_time - named);
  lines.push_back(fmt::format("kernels, and the bytes each has to move against a copy's {:.0f} GB/s:", copy / 1e9));
  lines.push_back(
      fmt::format("  {:28} {:>9} {:>10} {:>10} {:>7} {:>7}", "", "calls", "time [s]", "each [us]", "GB/s", "share"));
  const std::vector<Profile::Kernel> kernels = by_time(profile);
  double all = 0, rest = 0;
  for (const auto& k : kernels) all += k.seconds;
  for (const auto& k : kernels) {
    if (k.seconds < 0.005 * all) {
      rest += k.seconds;
      continue;
    }
    lines.push_back(fmt::format("  {:28} {:9} {:10.3f} {:10.1f}", k.name, k.calls, k.seconds,
                                1e6 * k.seconds / static_cast<double>(k.calls)));
    if (k.bytes > 0) lines.back() += fmt::format(" {:7.0f} {:5.0f} %", rate(k) / 1e9, 100 * rate(k) / copy);
  }
  if (rest > 0) lines.push_back(fmt::format("  {:28} {:>9} {:10.3f}", "all others", "", rest));
  lines.push_back(fmt::format("memory where the steps were taken, {:.1f} MB:", summary.memory / 1e6));
  for (const auto& [owner, bytes] : summary.memory_of)
    lines.push_back(fmt::format("  {:28} {:9.1f} MB", owner, bytes / 1e6));
  return lines;
}

std::string profile_csv(const Profile& profile, double copy) {
  std::string text = "kernel,phase,calls,seconds,bytes,share_of_copy_bandwidth\n";
  for (const auto& k : by_time(profile)) {
    text += fmt::format("{},{},{},{:.6g},", k.name, profile.phases()[k.phase].name, k.calls, k.seconds);
    text += k.bytes > 0 ? fmt::format("{:.6g},{:.4f}\n", k.bytes, rate(k) / copy) : ",\n";
  }
  return text;
}

}  // namespace talus::solver
