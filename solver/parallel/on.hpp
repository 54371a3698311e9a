// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which device the command line asks for.
#pragma once

namespace talus {

/// The device that the command line asks for; `automatic` takes the GPU where there is one, `gpus` all as one device.
enum class On { automatic, cpu, gpu, gpus };

}  // namespace talus
