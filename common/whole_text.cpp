// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/whole_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

namespace talus {
namespace fs = std::filesystem;

std::string whole_text(const fs::path& file, std::uintmax_t most,
                       const std::function<void(const std::string& reason)>& refuse) {
  std::error_code unknown;
  if (fs::is_directory(file, unknown)) refuse("it is a folder");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(std::generic_category().message(errno));
  std::string text;
  std::vector<char> part(std::size_t{1} << 16);
  while (stream && text.size() <= most) {  // a device would never end
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) refuse(std::generic_category().message(errno));
  if (text.size() > most) refuse(fmt::format("it is longer than {} MB", most >> 20));
  return text;
}

std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace talus
