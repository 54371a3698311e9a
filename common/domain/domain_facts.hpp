// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What domain.vdb says about itself, without its points.
#pragma once

#include <filesystem>

#include "common/stage/identity.hpp"

namespace talus {

/// The provenance of a domain. Only the head of the file is read, once its seal has been checked.
/// Throws DataError as read_domain() does.
Facts domain_facts(const std::filesystem::path& file);

}  // namespace talus
