// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What fills the history of a run: recorders, each with a table of columns.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/run/run_file.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/run/recorders/checkpoint.hpp"

namespace talus::solver {

/// The run at the time of a record.
struct Instant {
  double time;               ///< [s]
  Clock clock;               ///< of the last step
  Energies energies;         ///< sums over the points
  double step_over_cfl;      ///< of the last step [-]
  const RunMemory& counted;  ///< iterations, step cuts and outflow so far
  Solver& solver;            ///< for what costs more than a look: thickness, points
};

/// A column of the history, as a function of what its recorder samples.
template <class Sample>
struct Column {
  const char* name;  ///< with its unit; after the prefix of its place
  const char* unit;  ///< as RunHistory has it
  double (*value)(const Sample&);
  const char* quantity = "";  ///< what is measured, where the column belongs to a place
};

/// A thing or a point of the map that has columns of its own.
struct Place {
  std::string prefix;  ///< of its columns: "gauge_bridge_"; empty for the run itself
  std::string words;   ///< "gauge bridge"; empty for the run itself
};

/// The interface of what adds columns to the history of a run and fills them at every record.
class Recorder {
 public:
  virtual ~Recorder() = default;
  /// The method adds the recorder's columns, without values.
  virtual void add_columns(RunHistory& history) const = 0;
  /// The method appends one value to each of them.
  virtual void record(const Instant& now, RunHistory& history) = 0;
  /// The method writes down for a checkpoint what the recorder knows beyond the rows so far.
  virtual void keep(RunMemory&) const {}
  /// The method goes on from what was written down. It throws DataError where that does not fit.
  virtual void restore(const RunMemory&) {}
  /// The method logs results and adds findings at the end of the run.
  virtual void conclude(const RunHistory&) const {}
  /// Whether its columns tell if a run can be trusted, also where nobody reads them otherwise.
  virtual bool judges() const { return false; }
};

/// A recorder with the same columns for every one of its places.
template <class Sample>
class TableRecorder : public Recorder {
 public:
  TableRecorder(std::span<const Column<Sample>> table, std::vector<Place> places)
      : table_(table), places_(std::move(places)) {}

  /// The method adds the columns of every place.
  void add_columns(RunHistory& history) const override {
    for (const Place& place : places_) {
      for (const Column<Sample>& column : table_)
        history.columns.push_back({.name = place.prefix + column.name,
                                   .unit = column.unit,
                                   .quantity = column.quantity,
                                   .place = place.words,
                                   .values = {}});
    }
  }

  /// The method appends the values of every place.
  void record(const Instant& now, RunHistory& history) override {
    const std::vector<Sample> taken = samples(now);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      for (const Column<Sample>& column : table_)
        history.at(places_[i].prefix + column.name).values.push_back(column.value(taken[i]));
    }
  }

 protected:
  /// One sample for each place, in their order.
  virtual std::vector<Sample> samples(const Instant& now) const = 0;

 private:
  std::span<const Column<Sample>> table_;
  std::vector<Place> places_;
};

}  // namespace talus::solver
