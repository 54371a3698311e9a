// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/error.hpp"

namespace talus {
namespace {

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
    : std::runtime_error(join(faults)), code_(code), faults_(std::move(faults)) {}

}  // namespace talus
