// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A page with its data.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace talus::postprocess {

/// The page (page.hpp) with title and data in their places, and with the hashes of its scripts and styles, which are
/// all that a browser is to run.
std::string filled_page(std::string_view page, const std::string& title, const nlohmann::ordered_json& data);

/// The source by which a Content-Security-Policy lets one inline script or style in, and no other: "'sha256-...'".
std::string policy_source(std::string_view inline_text);

/// Texts that name files, as a page may say them that is sent on: without the folders.
void leave_out_folders(nlohmann::ordered_json& json);

}  // namespace talus::postprocess
