// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs variants of a case's recipe through the programs and keeps the rows of the table.
#pragma once

#include <functional>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/run/run_file.hpp"
#include "tests/validation/costs.hpp"
#include "tests/validation/points.hpp"
#include "tests/validation/recipe_text.hpp"

namespace talus::validation {

/// What was asked of the driver.
struct Request {
  std::filesystem::path programs, recipes, out;  // folders: build/bin, tests/validation, build/validation
  std::string on = "auto";                       // auto | cpu | gpu
  bool complete = false;                         // with the long runs
  bool coarse = false;                           // on coarse grids alone: seconds a case, for CTest
  CostBook costs;                                // what runs have cost, and may again
};

/// A variant that was run. `fault` says why there is no result.
struct Outcome {
  std::string variant;
  std::string fault;
  Run run;
  std::vector<Points> frames;

  bool ok() const { return fault.empty(); }
  const Points& first() const { return frames.front(); }
  const Points& last() const { return frames.back(); }
  /// A column of the history; empty where the solver writes none of that name.
  std::vector<double> history(const std::string& name) const;
  double last_of(const std::string& name) const;  ///< its last value, NaN where there is none
};

/// An ensemble that was run: what it was asked for, and what came of it. `outcome` has no run and no frames.
struct MembersOutcome {
  Outcome outcome;
  MemberTable table;
  EnsembleCounts counts;
};

/// One line of the table.
struct Row {
  std::string name, quantity;  // "A1 quasi-static, pcg", "top displacement"
  double computed, reference, error, tolerance;
  bool judged = false;  // against a tolerance, a band or a bound; else the number is noted and claims nothing
  bool pass = false;    // where it is judged
  double wall_time = 0, particles = 0, steps = 0, newton = 0, cg = 0, over_cfl = 0;  // NaN: the run does not say
  std::string place, fault;

  /// Whether something is wrong: a goal is missed, or there is no result.
  bool failed() const { return judged ? !pass : !fault.empty(); }
};

class Bench {
 public:
  /// `keep` gets each row as it is judged.
  Bench(std::string name, const Request& request, std::function<void(const Row&)> keep)
      : name_(std::move(name)), request_(request), keep_(std::move(keep)) {}

  const std::string& name() const { return name_; }
  const Request& request() const { return request_; }
  bool complete() const { return request_.complete; }
  bool coarse() const { return request_.coarse; }
  bool on_gpu() const { return request_.on == "gpu"; }

  /// Run the case's recipe with these overrides; results lie in OUT/CASE/VARIANT. Says on stderr what it does. With
  /// `profile` the run measures its phases (RunSummary::profile). Rows judge its cost where the book knows the run.
  Outcome run(const std::string& variant, const Overrides& overrides, bool profile = false);
  /// The same with a recipe of an ensemble.
  MembersOutcome run_members(const std::string& variant, const Overrides& overrides);

  /// A row whose error is |computed / reference - 1|, or |computed| where the reference is 0. A run without a result is
  /// a failed row without numbers.
  void compare(const Outcome& outcome, const std::string& quantity, double computed, double reference,
               double tolerance);
  /// A row whose error is `computed` itself: norms, distances between two results.
  void measure(const Outcome& outcome, const std::string& quantity, double computed, double tolerance) {
    compare(outcome, quantity, computed, 0, tolerance);
  }
  /// A row that `computed` passes from `reference` on; its error is what is missing.
  void at_least(const Outcome& outcome, const std::string& quantity, double computed, double reference);

  /// A row that `computed` passes up to `reference`; its error is what is too much.
  void at_most(const Outcome& outcome, const std::string& quantity, double computed, double reference);
  /// A row that `computed` passes from `low` to `high`; its error is how far beyond the nearer end it lies, over that.
  void within(const Outcome& outcome, const std::string& quantity, double computed, double low, double high);
  /// A row that says what was measured and claims nothing.
  void note(const Outcome& outcome, const std::string& quantity, double computed);

  /// What the runs made so far have cost.
  const CostBook& costs() const { return costs_; }

  /// Write a picture OUT/NAME.png.
  void picture(const std::string& name, const std::string& png) const;

 private:
  std::filesystem::path folder(const std::string& variant) const;
  /// Runs the stages, and returns what went wrong.
  std::string run_stages(const std::string& variant, const Overrides& overrides, bool profile) const;
  Row row_of(const Outcome& outcome, const std::string& quantity) const;
  void judge(Row row);
  void judge_cost(const Outcome& outcome);

  std::string name_;
  const Request& request_;
  std::function<void(const Row&)> keep_;
  CostBook costs_;
};

}  // namespace talus::validation
