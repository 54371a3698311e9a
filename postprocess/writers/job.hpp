// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Input of the writers.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "common/run/run_file.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// A run, its reference, and the results derived from both.
struct Job {
  std::filesystem::path file{};  ///< run.h5
  Run run{};
  Options options{};
  std::optional<Survey> survey{};
  Thalweg thalweg{};
  Hazard hazard{};
  Score score{};
  std::filesystem::path out{};          ///< output folder
  std::string command_line{};           ///< for file metadata
  std::function<std::string()> used{};  ///< text of postprocess.used.toml
};

/// Writes OUT/NAME, aside and renamed. Returns the path. Throws DataError, Interrupted.
std::filesystem::path write_file(const Job& job, const std::string& name, const std::string& bytes);

/// Makes OUT/NAME where it is missing. Returns the path.
std::filesystem::path folder_of(const Job& job, const std::string& name);

}  // namespace talus::postprocess
