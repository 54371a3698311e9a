// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// History: the numbers of a run over time, written as /history of run.h5, and the recorders that fill it, each with a
// table of columns.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/run/run_file.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/recorders/checkpoint.hpp"

namespace talus::solver {

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

/// The start of the names of a thing's columns: "gauge_bridge_".
inline std::string prefix_of(const std::string& kind, const std::string& name) { return kind + "_" + name + "_"; }

/// The places of things of one kind that have names.
template <class Named>
std::vector<Place> places_of(const std::string& kind, const std::vector<Named>& things) {
  std::vector<Place> places;
  for (const Named& one : things) places.push_back({prefix_of(kind, one.name), kind + " " + one.name});
  return places;
}

/// A place of the map from the centre of its first cell, east and north [cells].
inline std::array<double, 2> in_cells(const MapGrid& map, double x, double y) {
  return {(x - map.west) / map.cell - 0.5, (y - map.south) / map.cell - 0.5};
}

/// The interface of what adds columns to the history of a run and fills them at every record.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void add_columns(RunHistory& history) const = 0;           ///< adds the recorder's columns, without values
  virtual void record(const Instant& now, RunHistory& history) = 0;  ///< appends one value to each of them
  /// The method writes down for a checkpoint what the recorder knows beyond the rows so far.
  virtual void keep(RunMemory&) const {}
  /// The method goes on from what was written down. It throws DataError where that does not fit.
  virtual void restore(const RunMemory&) {}
  virtual void conclude(const RunHistory&) const {}  ///< logs results and adds findings at the end of the run
  /// Whether its columns tell if a run can be trusted, also where nobody reads them otherwise.
  virtual bool judges() const { return false; }
};

/// A recorder with the same columns for every one of its places.
template <class Sample>
class TableRecorder : public Recorder {
 public:
  TableRecorder(std::span<const Column<Sample>> table, std::vector<Place> places)
      : table_(table), places_(std::move(places)) {}

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

/// What a history is for: to be kept with the run, or to judge by whether the run can be trusted.
enum class HistoryUse { kept, judged };

/// The history of a run: its columns and the recorders that fill them.
class History {
 public:
  /// Makes the recorders that the recipe asks for, which may keep references to the scene; of a history to judge by
  /// those alone that tell something of that. Throws RecipeError where one of them cannot measure what it is asked to.
  History(const SolveOptions& options, const Scene& scene, HistoryUse use = HistoryUse::kept);

  void record(const Instant& now) {
    for (const auto& recorder : recorders_) recorder->record(now, rows_);
  }
  /// The method writes the rows so far down for a checkpoint, and what recorders know besides.
  void keep(RunMemory& memory) const;
  /// The method goes on from the memory of a checkpoint. It throws DataError when its columns are others.
  void restore(const RunMemory& memory);

  const RunHistory& rows() const { return rows_; }  ///< all rows so far, column by column
  double last(const std::string& name) const;       ///< last value of a column, 0 before the first record
  /// Logs results and adds findings at the end of the run.
  void conclude() const {
    for (const auto& recorder : recorders_) recorder->conclude(rows_);
  }

 private:
  std::vector<std::unique_ptr<Recorder>> recorders_;
  RunHistory rows_;
};

}  // namespace talus::solver
