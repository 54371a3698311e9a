// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs variants of a case's recipe through the programs, reads their points and keeps the rows of the table.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/run/run_file.hpp"
#include "tests/validation/closed_forms.hpp"
#include "tests/validation/recipe_text.hpp"

namespace talus::validation {

/// Index = id; a point that left the domain has NaN for a position. Of a point that was split, the first part has its
/// place, and the others stand behind all ids.
struct Points {
  double time = 0;                              // [s]
  std::vector<std::array<double, 3>> position;  // [m]
  std::vector<std::array<float, 3>> velocity;   // [m/s]
  std::vector<float> volume;                    // initial [m3]
  std::vector<float> pressure;                  // minus the mean Kirchhoff stress [Pa]
  std::size_t size() const { return position.size(); }
  std::size_t add();  // one more, whose place it returns
};

/// From group VTKHDF of run.h5; none where it has no frames of points, as a search for a factor. Throws DataError.
std::vector<Points> read_points(const std::filesystem::path& run);

/// The centre of mass [m]; NaN where points left the domain.
std::array<double, 3> centre_of(const Points& points);

/// The thickness at which a deposit of sand ends: two of the glass beads of Lajeunesse et al. (2005) [m].
inline constexpr double front_thickness = 2 * 1.15e-3;

/// Where a deposit along x ends: the furthest place with a cell behind it in which it is as thick as that on average;
/// `breadth`: of the deposit at x [m]. Single grains roll on.
double front_of(const Points& points, double cell, const std::function<double(double)>& breadth);

/// How far along x 99 % of the volume got [m]. Points that left do not count; there must be one.
double reach_of(const Points& points);

/// The cost of a run: steps, and Newton's and linear iterations where there are any, else 0.
struct Cost {
  long steps = 0, newton = 0, linear = 0;
};

/// The most that a number of the book may have become: 15 % and two more. The order of sums, which threads decide,
/// moves the iterations of a flow by a few per cent; a change that costs more than this should be known.
long cost_bound(long recorded);

/// Costs by run, "A1 quasi-static, quadratic, pcg".
using CostBook = std::map<std::string, Cost>;

/// The book in a file; empty where there is none. Throws std::runtime_error: no table of three whole numbers a run.
CostBook read_costs(const std::filesystem::path& file);

/// The text of the file.
std::string as_toml(const CostBook& book);

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
  double lowest, highest;  // ends of the band, or the reference twice; infinite: no bound on that side
  bool judged = false;     // against a tolerance, a band or a bound; else the number is noted and claims nothing
  bool pass = false;       // where it is judged
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
  /// A row that `computed` passes within a band; its error is how far beyond the nearer end it lies, over that.
  void within(const Outcome& outcome, const std::string& quantity, double computed, const Band& band,
              double tolerance = 0);
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
  /// What a number has to be, as in a row.
  struct Claim {
    double reference, error, tolerance, lowest, highest;
  };
  void judge(const Outcome& outcome, const std::string& quantity, double computed, const Claim& claim);
  void judge_cost(const Outcome& outcome);

  std::string name_;
  const Request& request_;
  std::function<void(const Row&)> keep_;
  CostBook costs_;
};

}  // namespace talus::validation
