// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What looks wrong but may be right: refused, unless the recipe insists on it by name.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"

namespace talus {

/// Something that is not meaningless but hardly ever right. The mend of its fault says what to do where it is wrong;
/// how to insist on it is added by Acceptance.
struct Implausible {
  std::string name;  ///< by which a recipe accepts it: "swapped-surveys"
  Fault fault;
};

/// What the analyst insists on: the key `accept` of a recipe's table, and what of it was met.
class Acceptance {
 public:
  Acceptance() = default;
  /// `table` as messages call it: "preprocess".
  Acceptance(std::string table, std::vector<std::string> names) : table_(std::move(table)), names_(std::move(names)) {}

  /// From now on judge() keeps what it refuses for settle(), so that a stage says all of it at once.
  void collect() { collecting_ = true; }
  /// Throws DataError that names key and value of the recipe, unless it is accepted: then warns, and keeps it.
  void judge(const Implausible& finding);
  /// Throws one DataError of all that was refused since collect().
  void settle();
  /// What `work` returns. Where a DataError ends it, what was refused before stands in front of it: it may be why.
  template <class Work>
  auto meanwhile(const Work& work) {
    try {
      return work();
    } catch (const DataError& error) {
      refused_.insert(refused_.end(), error.faults().begin(), error.faults().end());
      throw DataError(std::exchange(refused_, {}));
    }
  }
  /// Warns of names in the recipe that nothing met, neither here nor in `others` (facts as of facts()): the next
  /// mistake of this kind would pass unseen.
  void warn_of_unmet(const std::vector<std::pair<std::string, std::string>>& others = {}) const;
  /// What was insisted on: a fact for each, "accepted.NAME" and the words of the refusal. It goes with the results.
  const std::vector<std::pair<std::string, std::string>>& facts() const { return facts_; }

 private:
  std::string table_;
  std::vector<std::string> names_;
  std::vector<std::pair<std::string, std::string>> facts_;
  bool collecting_ = false;
  std::vector<Fault> refused_;
};

/// The warning that says what was insisted on: name, and the words of the refusal.
std::string accepted_warning(const std::string& name, const std::string& words);
/// Warnings but those that say what was insisted on, which facts() keep.
std::vector<std::string> without_accepted(std::vector<std::string> warnings);
/// The fact of what was insisted on by this name.
std::string accepted_fact(const std::string& name);
/// What was insisted on as one line, for the metadata of maps; "" for nothing.
std::string accepted_line(const std::vector<std::pair<std::string, std::string>>& facts);
/// Of facts kept with a result, those of what was insisted on: name, and the words of the refusal.
std::vector<std::pair<std::string, std::string>> accepted_in(
    const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace talus
