// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a domain says of itself: from which files, by which recipe, and what is in it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/scene/prepare.hpp"

namespace talus::preprocess {

/// Grid, points and volumes of a domain.
Facts facts_of(const Prepared& prepared);

/// Files with their checksums.
Facts checksums_of(const std::vector<std::filesystem::path>& files);

/// Refuses (DataError) files that can no longer be read, or are not what `inputs`, of checksums_of(), says of them: a
/// scene that cannot be made while its files are at fault is not itself at fault.
void require_unchanged(const Facts& inputs);

/// Whose domain it is: the same for the same `used` values of [preprocess], inputs and version, wherever they lie and
/// whenever it runs, so that a recipe and its used recipe make the same. `more` tells domains of one recipe apart.
Facts marks_of(const recipe::Recipe& recipe, const Options& used, const Facts& inputs, const std::string& more = "");

/// All that a domain carries: scene, version, command, hardware, then inputs, marks and facts.
Facts provenance_of(const StageContext& context, const Facts& inputs, const Facts& marks, const Facts& facts);

}  // namespace talus::preprocess
