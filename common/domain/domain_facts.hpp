// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What domain.vdb says about itself, without its points.
#pragma once

#include <filesystem>

#include "common/stage/identity.hpp"

namespace talus {

/// The provenance of a domain. Of a file with a seal no more than its head is read, once the seal has been checked.
/// Throws DataError as read_domain() does.
Facts domain_facts(const std::filesystem::path& file);

}  // namespace talus
