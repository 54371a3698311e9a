// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/run_facts.hpp"

#include "common/run/trusted_file.hpp"

namespace talus {

Facts run_facts(const std::filesystem::path& file) {
  return run_facts(h5::open_trusted(file, {file, "Run talus-solve again"}).file);
}

Facts run_facts(const h5::File& file) {
  Facts facts;
  for (const auto& name : file.children("/provenance")) {
    const auto group = "/provenance/" + name;
    facts.emplace_back(file.text(group, "key"), file.text(group, "value"));
  }
  return facts;
}

}  // namespace talus
