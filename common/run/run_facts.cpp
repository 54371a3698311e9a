// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/run_facts.hpp"

#include "common/run/grid_attributes.hpp"
#include "common/run/sealed_file.hpp"

namespace talus {

Facts run_facts(const std::filesystem::path& file) {
  return run_facts(h5::open_sealed(file, {file, "Run talus-solve again"}));
}

Facts run_facts(const h5::File& file) { return h5::read_facts(file, "/provenance"); }

}  // namespace talus
