#include "common/stage/interrupt.hpp"

#include <unistd.h>

#include <csignal>

#include "common/stage/stage.hpp"

namespace talus {
namespace {

volatile std::sig_atomic_t signals_seen = 0;

extern "C" void talus_on_signal(int) {
  if (signals_seen != 0) ::_exit(static_cast<int>(ExitCode::interrupted));
  signals_seen = 1;
}

}  // namespace

void watch_for_interrupts() {
  struct sigaction action {};
  action.sa_handler = talus_on_signal;
  action.sa_flags = SA_RESTART;  // a library in the middle of a write must not see EINTR
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return signals_seen != 0; }

}  // namespace talus
