// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/sealed_file.hpp"

#include <fmt/format.h>

#include "common/stage/checksum.hpp"
#include "common/stage/crash_report.hpp"
#include "common/stage/write_fault.hpp"

namespace talus::h5 {

void set_format(File& file, const Format& format) {
  file.set_text("/", "format", format.mark);
  file.set_integer("/", "format_version", format.version);
}

File open_sealed(const std::filesystem::path& path, const Naming& naming) {
  require_seal(path, naming.mend);
  const WhileReading reading(path, naming.mend);
  return File::open(path, naming);
}

File open_sealed(const std::filesystem::path& path, const Naming& naming, const Format& format) {
  File file = open_sealed(path, naming);
  if (!file.has_attribute("/", "format") || file.text("/", "format") != format.mark)
    file.refuse(fmt::format("is not {}", format.words), "its mark is missing");
  const auto found = file.integer("/", "format_version");
  if (found != format.version) refuse_format(naming.shown, found, format.version, naming.mend);
  return file;
}

}  // namespace talus::h5
