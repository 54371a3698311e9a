// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/machine.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include "common/error.hpp"
#include "common/stage/context.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The first words of a small file of the system as numbers; "max" and what is missing: empty.
std::optional<double> number_in(const fs::path& file, int word = 0) {
  std::ifstream stream(file);
  std::string text;
  for (int i = 0; i <= word; ++i)
    if (!(stream >> text)) return std::nullopt;
  std::istringstream digits(text);
  double value = 0;
  return digits >> value ? std::optional(value) : std::nullopt;
}

/// A folder of control groups and those above it, for the group that this process is in.
struct Group {
  fs::path mount, path;
};

/// Groups of a controller: version 2 ("0::/path") and version 1 ("4:memory:/path").
std::vector<Group> groups_of(const std::string& controller) {
  std::vector<Group> groups;
  std::ifstream stream("/proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string names = "," + line.substr(first + 1, second - first - 1) + ",";
    const fs::path path = fs::path(line.substr(second + 1)).relative_path();
    if (names == ",,") groups.push_back({"/sys/fs/cgroup", path});
    if (names.find("," + controller + ",") != std::string::npos)
      groups.push_back({fs::path("/sys/fs/cgroup") / names.substr(1, names.size() - 2), path});
  }
  return groups;
}

/// The least of `limit_in(folder)` over the groups of a controller and all above them.
template <class LimitIn>
double least_limit(const std::string& controller, const LimitIn& limit_in) {
  double least = unlimited;
  for (const Group& group : groups_of(controller))
    for (fs::path path = group.path;; path = path.parent_path()) {
      least = std::min(least, limit_in(group.mount / path));
      if (path.empty()) break;
    }
  return least;
}

double processors_in(const fs::path& folder) {
  const auto quota = number_in(folder / "cpu.max"), period = number_in(folder / "cpu.max", 1);
  if (quota && period && *period > 0) return *quota / *period;
  const auto old_quota = number_in(folder / "cpu.cfs_quota_us"), old_period = number_in(folder / "cpu.cfs_period_us");
  return old_quota && old_period && *old_quota > 0 && *old_period > 0 ? *old_quota / *old_period : unlimited;
}

double memory_in(const fs::path& folder) {
  return std::min(number_in(folder / "memory.max").value_or(unlimited),
                  number_in(folder / "memory.limit_in_bytes").value_or(unlimited));
}

double own_limit(int resource) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return unlimited;
  return static_cast<double>(limit.rlim_cur);
}

std::string size_words(double bytes) {
  return bytes < 1e12 ? fmt::format("{:.3g} GB", bytes * 1e-9) : fmt::format("{:.3g} TB", bytes * 1e-12);
}

/// The pieces of work while threads take them.
class Shared {
 public:
  Shared(std::size_t count, const std::function<void(std::size_t)>& work)
      : count_(count), work_(work), place_of_failure_(count) {}

  void take_all() {
    while (!interrupted() && !failed_) {
      const std::size_t place = next_++;
      if (place >= count_) return;
      try {
        work_(place);
        ++done_;
      } catch (...) {
        note_failure(place);
      }
    }
  }
  bool all_done() const { return done_ == count_; }
  std::exception_ptr failure() const { return failure_; }

 private:
  void note_failure(std::size_t place) {
    const std::lock_guard lock(mutex_);
    failed_ = true;
    if (place >= place_of_failure_) return;
    place_of_failure_ = place;
    failure_ = std::current_exception();
  }

  std::size_t count_;
  const std::function<void(std::size_t)>& work_;
  std::atomic<std::size_t> next_{0}, done_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::size_t place_of_failure_;
};

std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";  // /proc/cpuinfo has no model name on some ARM systems
}

}  // namespace

int usable_threads() {
  double threads = std::max(1U, std::thread::hardware_concurrency());
  cpu_set_t mask;
  CPU_ZERO(&mask);
  if (sched_getaffinity(0, sizeof mask, &mask) == 0) threads = std::min(threads, static_cast<double>(CPU_COUNT(&mask)));
  return static_cast<int>(std::max(1.0, std::min(threads, std::ceil(least_limit("cpu", processors_in)))));
}

int thread_limit() { return context().threads > 0 ? context().threads : usable_threads(); }

double memory_of_machine(std::string_view name) {
  std::ifstream stream("/proc/meminfo");
  std::string found, unit;
  double kilobytes = 0;
  while (stream >> found >> kilobytes) {
    std::getline(stream, unit);
    if (found.size() == name.size() + 1 && found.starts_with(name)) return kilobytes * 1024;
  }
  return unlimited;
}

double age_of_process() {
  std::ifstream stream("/proc/self/stat");
  const std::string all{std::istreambuf_iterator<char>(stream), {}};
  std::istringstream behind_name(all.substr(all.rfind(')') + 1));
  std::string word;
  for (int field = 3; field <= 22; ++field) behind_name >> word;  // the last is starttime, in ticks of the machine
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) -
         std::strtod(word.c_str(), nullptr) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

double usable_memory() {
  return std::min(
      {memory_of_machine("MemTotal"), least_limit("memory", memory_in), own_limit(RLIMIT_AS), own_limit(RLIMIT_DATA)});
}

void require_memory(double bytes, const std::string& what, const std::string& mend) {
  const double limit = usable_memory();
  if (bytes <= limit) return;
  throw DataError(
      Fault{what, fmt::format("{} are needed, this process may have {}", size_words(bytes), size_words(limit)), mend});
}

void in_threads(std::size_t count, const std::string& doing, const std::function<void(std::size_t place)>& work,
                std::size_t most) {
  const std::size_t wanted = std::min({count, most, static_cast<std::size_t>(std::max(1, thread_limit()))});
  Shared shared(count, work);
  {
    std::vector<std::jthread> others;
    try {
      while (others.size() + 1 < wanted)
        others.emplace_back([&, &here = context()] {
          const CrashStack room;
          const BindContext bind(here);
          shared.take_all();
        });
    } catch (const std::system_error&) {  // the system gives no more threads: those that there are do the work
    }
    shared.take_all();
  }
  if (shared.failure()) std::rethrow_exception(shared.failure());
  if (!shared.all_done()) stop_if_interrupted(doing);
}

std::string hardware() {
  const int threads = thread_limit();
  return fmt::format("{}, {} thread{}", processor_name(), threads, threads == 1 ? "" : "s");
}

}  // namespace talus
