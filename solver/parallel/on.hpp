// Which device the command line asks for.
#pragma once

namespace talus {

/// `automatic` takes the GPU where there is one.
enum class On { automatic, cpu, gpu };

}  // namespace talus
