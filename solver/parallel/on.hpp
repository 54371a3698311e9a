// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which device the command line asks for.
#pragma once

#include <iterator>
#include <optional>
#include <string_view>

namespace talus {

/// The device that the command line asks for; `automatic` takes the GPU where there is one, `gpus` all as one device.
enum class On { automatic, cpu, gpu, gpus };

inline constexpr std::string_view on_words[] = {"auto", "cpu", "gpu", "gpus"};  ///< in the order of On

/// The device of that word; none where it is no such word.
constexpr std::optional<On> on_called(std::string_view word) {
  for (std::size_t n = 0; n < std::size(on_words); ++n)
    if (word == on_words[n]) return static_cast<On>(n);
  return std::nullopt;
}

}  // namespace talus
