// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/domain_facts.hpp"

#include "common/domain/domain_layout.hpp"
#include "common/stage/checksum.hpp"

namespace talus {
namespace {

std::string text(const openvdb::MetaMap& meta, const std::string& name) {
  const auto value = meta.getMetadata<openvdb::StringMetadata>(name);
  return value ? value->value() : "";
}

}  // namespace

Facts domain_facts(const std::filesystem::path& file) {
  constexpr const char* again = "Run talus-preprocess again, or copy it again";
  require_seal(file, again);
  openvdb::initialize();
  Facts facts;
  try {
    openvdb::io::File head(file.string());
    head.open();  // grids are read when they are asked for
    const auto meta = head.getMetadata();
    for (std::size_t i = 0; !text(*meta, layout::numbered("fact_name", i)).empty(); ++i)
      facts.emplace_back(text(*meta, layout::numbered("fact_name", i)), text(*meta, layout::numbered("fact_value", i)));
  } catch (const openvdb::Exception& error) {
    throw DataError({file.string() + ": not a whole domain", error.what(), again});
  }
  return facts;
}

}  // namespace talus
