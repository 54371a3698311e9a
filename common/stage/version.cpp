// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/stage.hpp"

namespace talus {

std::string version() { return TALUS_VERSION " (" TALUS_COMMIT ")"; }

}  // namespace talus
