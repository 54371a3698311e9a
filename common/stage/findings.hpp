// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a stage finds doubtful: advice, warnings, and refusals that the recipe overrides by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"

namespace talus {

/// How much a finding weighs. A refusal ends a stage unless the recipe overrides it.
enum class Severity { advice, warning, refusal };

/// A number that a finding is about. `unit` as in results: "m", "m3", "1" for none.
struct FindingNumber {
  std::string name;
  double value = 0;
  std::string unit;
  bool operator==(const FindingNumber&) const = default;
};

/// One thing that a stage found.
struct Finding {
  static constexpr std::int64_t no_member = -1;

  Severity severity = Severity::warning;
  std::string name;     ///< by which scripts look for it and a recipe overrides it: "swapped-surveys"
  std::string message;  ///< a sentence or two with the numbers
  std::vector<FindingNumber> numbers = {};
  std::string stage = {};           ///< table of the recipe: "solve"
  std::string accepted_by = {};     ///< key of the recipe that overrides a refusal; empty for other severities
  std::int64_t member = no_member;  ///< of an ensemble that it is about
  bool operator==(const Finding&) const = default;
};

/// Collects the findings of the calling thread while it lives. Objects nest, and findings go to all of them, from the
/// innermost outwards to the first that keeps them back.
class Findings {
 public:
  /// Whether findings are logged and passed on as they come, or kept back. Then the thread logs nothing else either.
  enum class Log { now, kept_back };

  /// `stage`: table of the recipe; `accept`: names of refusals that the recipe overrides.
  explicit Findings(std::string stage, std::vector<std::string> accept = {}, Log log = Log::now);
  ~Findings();
  Findings(const Findings&) = delete;
  Findings& operator=(const Findings&) = delete;

  const std::vector<Finding>& list() const { return list_; }  ///< the findings so far, in order
  void settle();  ///< throws one DataError of all refusals that the recipe does not override
  /// Runs `work`, then settle(). Refusals stand in front of the faults of a DataError that ends it: they may be why.
  template <class Work>
  void settled(const Work& work) {
    try {
      work();
    } catch (const DataError& error) {
      refused_.insert(refused_.end(), error.faults().begin(), error.faults().end());
    }
    settle();
  }

 private:
  friend void add_finding(Finding finding);
  friend void add_findings(const std::vector<Finding>& findings);
  friend void refuse_unless_accepted(const std::string&, const Fault&, std::vector<FindingNumber>);
  friend std::vector<Finding> findings_so_far();
  friend bool log_is_kept_back();

  static void keep(const Finding& finding);  ///< adds to the lists of the thread

  std::string stage_;
  std::vector<std::string> accept_;
  bool passes_on_, kept_back_;
  std::vector<Finding> list_;
  std::vector<Fault> refused_;
  Findings* outer_;
};

/// Adds a finding to the lists of the thread and logs it. Of a finding without a stage the innermost list gives it.
void add_finding(Finding finding);
/// Adds findings of a stage before, which has logged them.
void add_findings(const std::vector<Finding>& findings);
/// Adds advice.
void advise(std::string name, std::string message, std::vector<FindingNumber> numbers = {});
/// Adds a warning.
void warn(std::string name, std::string message, std::vector<FindingNumber> numbers = {});
/// Refuses what is hardly ever right, unless the recipe overrides the name: then it is a finding. The innermost list
/// keeps the fault for settle(); without a list the function throws DataError.
void refuse_unless_accepted(const std::string& name, const Fault& fault, std::vector<FindingNumber> numbers = {});
/// Throws what the innermost list has refused so far, before work that refused numbers would only prolong.
void settle_findings();
/// All findings of the thread since its outermost list, or since the one that keeps them back.
std::vector<Finding> findings_so_far();
/// Warns of names in `accept` that no finding is of: the next mistake of this kind would pass unseen.
void warn_of_unused(const std::string& stage, const std::vector<std::string>& accept,
                    const std::vector<Finding>& findings);
/// Whether the thread logs nothing.
bool log_is_kept_back();

/// Whether one of the findings is a refusal of this name that was overridden.
bool is_accepted(const std::vector<Finding>& findings, const std::string& name);
/// The refusals that were overridden in one line, for the metadata of maps; "" for none.
std::string accepted_line(const std::vector<Finding>& findings);

/// Findings as an array of JSON, for all files.
std::string to_json(const std::vector<Finding>& findings);
/// The findings of such a text; none where it is no such text.
std::optional<std::vector<Finding>> findings_in(const std::string& json);

/// advice, warning or refusal.
const char* word_of(Severity severity);

}  // namespace talus
