// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/run_facts.hpp"

#include "common/run/trusted_file.hpp"

namespace talus {

Facts run_facts(const std::filesystem::path& file) {
  const h5::TrustedFile trusted = h5::open_trusted(file, {file, "Run talus-solve again"});
  Facts facts;
  for (const auto& name : trusted.file.children("/provenance")) {
    const auto group = "/provenance/" + name;
    facts.emplace_back(trusted.file.text(group, "key"), trusted.file.text(group, "value"));
  }
  return facts;
}

}  // namespace talus
