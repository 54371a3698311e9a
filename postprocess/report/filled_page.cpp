// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/report/filled_page.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/gis/escaped_xml.hpp"
#include "common/recipe/shown_paths.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/report/pack.hpp"

namespace talus::postprocess {
namespace {

using Json = nlohmann::ordered_json;

/// JSON inside <script>: no "<" may stand there, or a title could end the block.
std::string for_script(const Json& json) {
  const auto text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe.append("\\u003c") : safe.append(1, c);
  return safe;
}

/// The bytes of a SHA-256 given in hex.
std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

/// The sources that a Content-Security-Policy names for what stands between `open` and `close` in the page:
/// "'sha256-..' 'sha256-..'".
std::string hashes(std::string_view page, std::string_view open, std::string_view close) {
  std::string words;
  for (std::size_t at = page.find(open); at != std::string_view::npos; at = page.find(open, at)) {
    at += open.size();
    const std::size_t end = page.find(close, at);
    words += (words.empty() ? "" : " ") + policy_source(page.substr(at, end - at));
  }
  return words;
}

/// The page with its slots filled. They are looked for in the page itself and never in what fills them.
std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& slots) {
  std::string text;
  for (const auto& [slot, words] : slots) {
    const auto at = page.find(slot);
    if (at == std::string_view::npos) throw std::logic_error("the page has no " + std::string(slot));
    text += std::string(page.substr(0, at)) + words;
    page.remove_prefix(at + slot.size());
  }
  return text + std::string(page);
}

}  // namespace

std::string policy_source(std::string_view inline_text) {
  return fmt::format("'sha256-{}'", base64(from_hex(sha256_of_text(std::string(inline_text)))));
}

void leave_out_folders(nlohmann::ordered_json& json) {
  if (json.is_string()) json = without_absolute_paths(json.get<std::string>());
  if (!json.is_structured()) return;
  for (Json& item : json) leave_out_folders(item);
}

std::string filled_page(std::string_view page, const std::string& title, const Json& data) {
  return filled(page, {{"@HASHES_OF_SCRIPTS@", hashes(page, "<script>", "</script>")},
                       {"@HASHES_OF_STYLES@", hashes(page, "<style>", "</style>")},
                       {"@TITLE@", escaped_xml(title)},
                       {"@DATA@", for_script(data)}});
}

}  // namespace talus::postprocess
