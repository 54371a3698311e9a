// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/error.hpp"

namespace talus {
namespace {

/// Of more faults than this, those beyond the first 50 are counted. A recipe's own list ends at 50 and its count.
constexpr std::size_t most_faults = 60, shown_faults = 50;

std::vector<Fault> bounded(std::vector<Fault> faults) {
  if (faults.size() <= most_faults) return faults;
  const std::size_t rest = faults.size() - shown_faults;
  faults.erase(faults.begin() + shown_faults, faults.end());
  faults.push_back({std::to_string(rest) + " more faults", "", "Mend those above first"});
  return faults;
}

std::string join(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += (text.empty() ? "" : "\n") + to_string(fault);
  return text;
}

}  // namespace

std::string to_string(const Fault& fault) {
  std::string text = fault.what;
  if (!fault.why.empty()) text += " (" + fault.why + ")";
  if (!fault.mend.empty()) text += ". " + fault.mend;
  return text;
}

Error::Error(ExitCode code, std::vector<Fault> faults)
    : std::runtime_error(join(bounded(faults))), code_(code), faults_(bounded(std::move(faults))) {}

}  // namespace talus
