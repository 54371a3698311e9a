// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace talus::postprocess {

/// The page without its data: page/ and the libraries it uses, put together when the program is built. The data belong
/// where "@DATA@" stands, the title where "@TITLE@" does, and the hashes of its scripts and styles where
/// "@HASHES_OF_SCRIPTS@" and "@HASHES_OF_STYLES@" do.
std::string_view page_template();

/// The page of an ensemble, likewise.
std::string_view ensemble_template();

}  // namespace talus::postprocess
