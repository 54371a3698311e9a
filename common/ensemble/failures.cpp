// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/failures.hpp"

#include <fmt/format.h>

#include "common/run/hdf5.hpp"

namespace talus {

void write_failures(h5::File& file, const std::vector<MemberFailure>& failures) {
  file.make_group("/failures");
  for (std::size_t n = 0; n < failures.size(); ++n) {
    const auto group = fmt::format("/failures/{:06}", n);
    file.make_group(group);
    file.set_integer(group, "member", failures[n].member);
    file.set_text(group, "words", failures[n].words);
  }
}

std::vector<MemberFailure> read_failures(const h5::File& file) {
  std::vector<MemberFailure> failures;
  if (!file.exists("/failures")) return failures;
  for (const std::string& name : file.children("/failures")) {
    const auto group = "/failures/" + name;
    failures.push_back({file.integer(group, "member"), file.text(group, "words")});
  }
  return failures;
}

}  // namespace talus
