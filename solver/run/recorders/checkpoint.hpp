// checkpoint.h5: everything from which --restart gives the result of an unbroken run.
#pragma once

#include <filesystem>
#include <string>

#include "common/run/run_file.hpp"
#include "solver/integrator/solver.hpp"

namespace talus::solver {

/// What the run itself remembers between steps.
struct RunMemory {
  std::int64_t frames = 0, records = 0, checkpoints = 0;  // events passed
  std::int64_t newton = 0, linear = 0, cuts = 0;          // iterations and step cuts so far
  double peak_kinetic = 0;                                // [J]
  double outflow_volume = 0;                              // [m3]
  std::int64_t outflow_count = 0;
  double wall_time = 0;                   // [s]
  std::vector<double> initial_thickness;  // [m]
  RunHistory history;
};

struct Checkpoint {
  std::string fingerprint;  // of domain and settings; a checkpoint of other ones is refused
  SolverState state;
  RunMemory memory;
};

/// Aside and renamed. Throws DataError.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws DataError when the file is missing, truncated, or made from another domain or other settings.
Checkpoint read_checkpoint(const std::filesystem::path& file, const std::string& fingerprint);

}  // namespace talus::solver
