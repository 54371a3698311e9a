// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The encoding of text in files: UTF-8, CP1252 (of which Latin-1's letters are a part), or UTF-16, which is refused.
#pragma once

#include <string>
#include <string_view>

namespace talus {

/// Whether bytes are valid UTF-8 (RFC 3629).
bool is_utf8(std::string_view bytes);

/// Text as UTF-8: what is none is taken as CP1252, of which every byte but five is a character (those become U+FFFD).
/// Control characters U+0080 to U+009F are taken so too: CP1252 that was declared as ISO 8859-1 leaves them.
std::string as_utf8(std::string_view text);

/// UTF-8 as CP1252, for a comparison with such text; '?' stands for what CP1252 has not.
std::string as_cp1252(std::string_view utf8);

/// "UTF-16", "UTF-16LE", "UTF-16BE" or "UTF-32", as iconv calls it, where a file that begins with these bytes holds
/// such text: by its byte-order mark, or by every second of its first bytes being zero and the others letters,
/// signs or blanks. Empty for any other.
std::string_view wide_encoding(std::string_view start);

/// How a file of an encoding is mended: the command that converts it.
std::string mend_of_encoding(std::string_view encoding, const std::string& file);

}  // namespace talus
