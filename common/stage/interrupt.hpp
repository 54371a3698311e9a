#pragma once

namespace talus {

/// From now on SIGINT and SIGTERM set interrupted(); a second one ends the process with 130 at once.
void watch_for_interrupts();

}  // namespace talus
