// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/input_file.hpp"

#include <cerrno>
#include <system_error>

#include "common/stage/context.hpp"
#include "common/stage/write_fault.hpp"
#include "common/whole_text.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

const char* kind_of(fs::file_type type) {
  switch (type) {
    case fs::file_type::fifo: return "it is a pipe";
    case fs::file_type::socket: return "it is a socket";
    case fs::file_type::character:
    case fs::file_type::block: return "it is a device";
    default: return nullptr;
  }
}

}  // namespace

void require_plain(const fs::path& file) {
  std::error_code unknown;
  const char* kind = kind_of(fs::status(file, unknown).type());
  if (kind != nullptr)
    refuse_file(file, "cannot be read", kind, "Give a plain file: it is read from several places, some of them twice");
}

void require_read(const std::ios& stream, const fs::path& file) {
  if (stream.bad())
    refuse_file(file, "cannot be read to its end", std::generic_category().message(errno),
                "Look at the disk, or copy the file again");
}

std::optional<std::string> text_if_there(const fs::path& file) {
  std::error_code error;
  const fs::file_type type = fs::status(file, error).type();
  if (type == fs::file_type::not_found) return std::nullopt;
  require_plain(file);
  return whole_text(file, std::uintmax_t{64} << 20, [&](const std::string& reason) {
    refuse_file(file, "cannot be read", reason, "Look at its permissions and at the disk, or make it again");
  });
}

bool network_allowed() { return context().network; }

}  // namespace talus
