// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/ensemble_file.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "common/run/trusted_file.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

std::string versions_read(const EnsembleFileKind& kind) {
  return kind.oldest == kind.version ? fmt::format("version {}", kind.version)
                                     : fmt::format("versions {} to {}", kind.oldest, kind.version);
}

}  // namespace

void write_ensemble_file(const std::filesystem::path& path, const EnsembleFileKind& kind,
                         const std::function<void(h5::File&)>& write) {
  PendingFile pending(path);
  h5::File file = h5::File::create(pending.path(), {pending.final_path(), ""});
  file.set_text("/", "format", kind.format);
  file.set_integer("/", "format_version", kind.version);
  write(file);
  file.close();
  seal_file(pending.path(), pending.final_path());
  pending.commit();
}

h5::File open_ensemble_file(const std::filesystem::path& path, const EnsembleFileKind& kind) {
  h5::TrustedFile trusted = h5::open_trusted(path, {path, kind.mend});
  if (!trusted.file.has_attribute("/", "format") || trusted.file.text("/", "format") != kind.format)
    trusted.file.refuse(fmt::format("is not {}", kind.words), "its mark is missing");
  const auto version = trusted.file.integer("/", "format_version");
  if (version < kind.oldest || version > kind.version)
    trusted.file.refuse(fmt::format("has layout version {}", version), "this program reads " + versions_read(kind));
  h5::expect_seal(trusted);
  return std::move(trusted.file);
}

}  // namespace talus
