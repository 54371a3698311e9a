// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Faults a program can meet, in three parts, and the exit code each kind ends with.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace talus {

/// What the process returns. 130 is the shell's own code for a program ended by Ctrl-C.
enum class ExitCode : int { success = 0, bug = 1, recipe = 2, data = 3, numerical = 4, interrupted = 130 };

/// One fault: *what* (*why it is wrong*) *how to mend it*.
struct Fault {
  std::string what;  ///< file, place in it and value: "before.tif: CRS is EPSG:4326"
  std::string why;   ///< "this stage needs metres"; may be empty
  std::string mend;  ///< "Reproject: gdalwarp -t_srs EPSG:<utm> before.tif out.tif"; may be empty
};

/// "what (why). mend"
std::string to_string(const Fault& fault);

/// The text with numbers of more than 18 digits before the point in short: 1e+300. What is part of a word stays.
std::string with_short_numbers(const std::string& text);

/// Base of the three kinds. Caught in run_stage() and nowhere else.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, std::vector<Fault> faults);
  ExitCode code() const { return code_; }                       ///< what the process returns
  const std::vector<Fault>& faults() const { return faults_; }  ///< all faults that were found

 private:
  ExitCode code_;
  std::vector<Fault> faults_;
};

/// The recipe or the command line is wrong (exit code 2).
struct RecipeError : Error {
  explicit RecipeError(std::vector<Fault> faults) : Error(ExitCode::recipe, std::move(faults)) {}
  explicit RecipeError(Fault fault) : RecipeError(std::vector{std::move(fault)}) {}
};

/// A file read or written is wrong (exit code 3).
struct DataError : Error {
  explicit DataError(std::vector<Fault> faults) : Error(ExitCode::data, std::move(faults)) {}
  explicit DataError(Fault fault) : DataError(std::vector{std::move(fault)}) {}
};

/// The computation failed: the text names the step, the particle and a mend (exit code 4).
struct NumericalError : Error {
  explicit NumericalError(Fault fault) : Error(ExitCode::numerical, {std::move(fault)}) {}
};

/// Ended by Ctrl-C after leaving what is needed to go on (exit code 130).
struct Interrupted : Error {
  explicit Interrupted(Fault fault) : Error(ExitCode::interrupted, {std::move(fault)}) {}
};

}  // namespace talus
