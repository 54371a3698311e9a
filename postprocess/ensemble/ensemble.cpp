// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "common/stage/identity.hpp"
#include "common/stage/machine.hpp"
#include "postprocess/ensemble/comparison.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/score/contingency.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

/// How many failures are told by their reasons; all stand in members.csv.
constexpr std::size_t failures_told = 5;

EnsembleCounts read_parts(const std::vector<fs::path>& files) {
  std::vector<EnsembleCounts> parts;
  for (const fs::path& file : files) {
    stop_if_interrupted("reading " + file.string());
    parts.push_back(read_counts(file));
  }
  return merged(std::move(parts), files);
}

/// Refuses counts of other members, or of a domain that another recipe made.
void judge_counts(const StageContext& context, const fs::path& file, const Ensemble& ensemble) {
  const EnsembleCounts& counts = ensemble.counts;
  if (counts.members != ensemble.table.count)
    throw DataError({fmt::format("{}: counts of an ensemble of {} members", file.string(), counts.members),
                     fmt::format("{} has {}", ensemble.files.front().string(), ensemble.table.count),
                     "Run talus-solve again"});
  const std::string of = fact(ensemble.table.provenance, base_domain_id), is = fact(counts.provenance, domain_id);
  if (!of.empty() && !is.empty() && of != is)
    throw DataError({fmt::format("{}: counts of members of the domain {}", file.string(), is),
                     fmt::format("{} names the domain {}", ensemble.files.front().string(), of),
                     "Run talus-solve again"});
  for (const auto& [table, name, program] : {std::tuple{"solve", recipe_of_run, "talus-solve"},
                                             std::tuple{"preprocess", recipe_of_domain, "talus-preprocess and solve"}})
    if (!fact(counts.provenance, name).empty())
      judge_maker(context.recipe,
                  {.file = file, .table = table, .mark = fact(counts.provenance, name), .program = program, .key = ""});
}

void tell_of_members(const Ensemble& ensemble) {
  const EnsembleCounts& counts = ensemble.counts;
  std::vector<std::int64_t> waiting;
  for (std::size_t k = 0; k < counts.states.size(); ++k)
    if (counts.states[k] == MemberState::waiting) waiting.push_back(static_cast<std::int64_t>(k));
  if (!waiting.empty())
    warn("members-not-run",
         fmt::format("{} of {} members have not been run: {}; the results are of the others, and talus-solve "
                     "runs them",
                     waiting.size(), counts.members, member_list(waiting)));
  std::vector<std::int64_t> failed;
  for (const MemberWords& failure : counts.failures) {
    if (failed.size() < failures_told)
      warn("member-failed", fmt::format("{} failed: {}", ensemble.table.name_of(failure.member), failure.words));
    failed.push_back(failure.member);
  }
  if (!failed.empty())
    warn("members-failed",
         fmt::format("{} of {} members failed ({}) and are left out of all counts; members.csv has the reasons",
                     failed.size(), counts.members, member_list(failed)));
  const std::vector<std::int64_t> edge = counts.at_edge();
  if (!edge.empty())
    warn("members-at-edge",
         fmt::format("{} came to the edge of their domain: {}; what lies beyond is missing from maps and numbers",
                     edge.size() == 1 ? "one member" : fmt::format("{} members", edge.size()),
                     ensemble.table.slides ? ensemble.table.names_of(edge, 12) : member_list(edge)));
}

/// Refuses (NumericalError) an ensemble of which more failed than failed_share allows: parts are judged by themselves.
void judge_failed(const EnsembleOptions& options, const Ensemble& ensemble) {
  const EnsembleCounts& counts = ensemble.counts;
  if (static_cast<double>(ensemble.failed()) <= options.may_fail(counts.members - counts.count(MemberState::left_out)))
    return;
  const MemberWords& first = counts.failures.front();
  throw NumericalError(
      options.too_many_failed(fmt::format("{} of {} members failed, the first is {}", ensemble.failed(), counts.members,
                                          ensemble.table.name_of(first.member)),
                              first.words));
}

std::string cell(const RowColumn& column, std::size_t member) {
  const double value = column.values[member];
  if (std::isnan(value)) return "";
  return column.words.empty() ? fmt::format("{}", value) : csv_field(column.words.at(static_cast<std::size_t>(value)));
}

/// The deposit of a member that was kept, on the survey's grid as that of a single run comes there.
OnSurveyGrid deposit_on_survey(const KeptThickness& deposit, const MapGrid& from, const Survey& survey,
                               const Options& options) {
  RunMaps maps;
  maps.grid = from;
  maps.deposit_thickness = deposit.thickness(from.count());
  maps.peak_thickness = maps.initial_thickness = std::vector<double>(from.count(), 0.0);
  return bring_to_survey_grid(maps, survey, options);
}

/// How the names of members' scores end: a number that is not the one of score.json has another name.
struct ScoreNames {
  const char *flow = "", *deposit = "", *thickness = "";
};

/// Members keep cells above one threshold, whatever the survey could detect, and some the thickness of deposits; of a
/// surveyed change, cells that were released are left out.
ScoreNames names_of_scores(const EnsembleCounts& counts, const Survey& survey, const Options& options) {
  double level = 0;
  for (std::size_t cell = 0; cell < survey.measured.size(); ++cell) level = std::fmax(level, survey.error.level(cell));
  const double threshold = counts.scene.threshold;
  const bool seen = level <= threshold;
  ScoreNames names;
  if (threshold != options.footprint_threshold || (survey.footprint_is_change && !seen)) names.flow = "_by_cells";
  const bool kept = std::ranges::any_of(counts.deposit_thickness, [](const KeptThickness& one) { return one.kept(); });
  if (!kept && (threshold != options.deposit_threshold || !seen)) names.deposit = "_by_cells";
  if (survey.deposit_is_change) names.deposit = names.thickness = "_outside_release";
  return names;
}

/// To how many members' cells of a footprint belong. Members may be added at the same time.
class CellShares {
 public:
  void add(const std::vector<double>& covered) {
    const std::lock_guard<std::mutex> one(mutex_);
    ++members_;
    counts_.resize(covered.size(), 0);
    for (std::size_t cell = 0; cell < covered.size(); ++cell)
      if (covered[cell] > most_of_a_cell) ++counts_[cell];
  }

  ShareScore score(const char* of, const std::vector<double>& surveyed, double threshold) const {
    std::vector<double> share = counts_;
    for (double& value : share) value /= members_;
    constexpr double few = 0.05, half = 0.5;
    return {of, compare(share, few, surveyed, threshold, 1).hit_rate(),
            compare(share, half, surveyed, threshold, 1).csi(), brier_score(share, surveyed, threshold)};
  }

 private:
  std::mutex mutex_;
  double members_ = 0;
  std::vector<double> counts_;
};

/// The scores of all members against one survey, one column each.
class Scores {
 public:
  Scores(const EnsembleCounts& counts, const Survey& survey, const Options& options)
      : counts_(counts),
        survey_(survey),
        surveyed_deposit_(comparable_deposit(survey, counts.scene)),
        options_(options),
        cell_area_(survey.grid.cell * survey.grid.cell),
        comparison_(counts, survey, surveyed_deposit_, options.calibrate, options.deposit_threshold) {
    const std::string footprint =
        fmt::format("footprint (thicker than {:g} m) against {}", counts.scene.threshold, survey.name);
    const std::string thickness = fmt::format("the deposit's thickness against {}", survey.name);
    const std::vector<double> none(counts.states.size(), nan);
    const ScoreNames end = names_of_scores(counts, survey, options);
    const auto column = [&](const std::string& name, const char* unit, const std::string& meaning) {
      return RowColumn{ColumnKind::score, name, unit, meaning, none, {}};
    };
    flow_ = {column(std::string("footprint_csi") + end.flow, "1", "critical success index of the " + footprint),
             column(std::string("footprint_hit_rate") + end.flow, "1", "hit rate of the " + footprint),
             column(std::string("footprint_false_alarm_ratio") + end.flow, "1", "false alarms of the " + footprint)};
    deposit_ = {
        column(std::string("deposit_csi") + end.deposit, "1", "critical success index of the deposit's " + footprint)};
    thickness_ = {
        column(fmt::format("thickness_rmse{}_m", end.thickness), "m", "root mean square error of " + thickness),
        column(fmt::format("thickness_bias{}_m", end.thickness), "m", "mean error of " + thickness)};
  }

  /// Writes the scores of member k; different members may be scored at the same time.
  void score(std::size_t k) {
    const MapGrid& from = counts_.scene.grid;
    const MapGrid& to = survey_.grid;
    if (!survey_.footprint.empty()) {
      const std::vector<double> touched = covered_shares(counts_.flow[k], from, to);
      const Contingency here =
          compare(touched, most_of_a_cell, survey_.footprint, survey_.footprint_threshold, cell_area_);
      flow_[0].values[k] = here.csi();
      flow_[1].values[k] = here.hit_rate();
      flow_[2].values[k] = here.false_alarm_ratio();
      flow_shares_.add(touched);
    }
    std::optional<OnSurveyGrid> own;
    if (!surveyed_deposit_.empty() && counts_.deposit_thickness[k].kept())
      own = deposit_on_survey(counts_.deposit_thickness[k], counts_.grid_of(static_cast<std::int64_t>(k)), survey_,
                              options_);
    if (!surveyed_deposit_.empty()) score_deposit(k, own);
    comparison_.compare(k, own ? &*own : nullptr);
  }

  /// The columns that have something to compare with.
  std::vector<RowColumn> columns() {
    std::vector<RowColumn> columns;
    const auto add = [&](std::vector<RowColumn>& more) { std::ranges::move(more, std::back_inserter(columns)); };
    if (comparison_.any())
      columns.push_back({ColumnKind::score,
                         "log_likelihood",
                         "1",
                         fmt::format("logarithm of the likelihood, given {}", survey_.name),
                         comparison_.logarithms(),
                         {}});
    if (!survey_.footprint.empty()) add(flow_);
    if (surveyed_deposit_.empty()) return columns;
    add(deposit_);
    if (std::ranges::any_of(counts_.deposit_thickness, [](const KeptThickness& one) { return one.kept(); }))
      add(thickness_);
    else
      log_info(
          "the members' deposits were not kept: no thickness_rmse_m ([ensemble] keep = [\"deposits\"] keeps them)");
    return columns;
  }

  /// What the shares of all members agree with; nothing where the survey says no everywhere.
  std::vector<ShareScore> of_shares() const {
    std::vector<ShareScore> all;
    if (!survey_.footprint.empty())
      all.push_back(flow_shares_.score("footprint", survey_.footprint, survey_.footprint_threshold));
    if (!surveyed_deposit_.empty())
      all.push_back(deposit_shares_.score("deposit", surveyed_deposit_, options_.deposit_threshold));
    std::erase_if(all, [](const ShareScore& one) { return std::isnan(one.held); });
    return all;
  }

  Json likelihood(bool drawn) const { return comparison_.any() ? comparison_.json(drawn) : Json(); }

 private:
  void score_deposit(std::size_t k, const std::optional<OnSurveyGrid>& own) {
    const std::vector<double> covered =
        own ? own->covered : covered_shares(counts_.deposit[k], counts_.scene.grid, survey_.grid);
    deposit_[0].values[k] =
        compare(covered, most_of_a_cell, surveyed_deposit_, options_.deposit_threshold, cell_area_).csi();
    deposit_shares_.add(covered);
    if (!own) return;
    const ThicknessError error = thickness_error(own->deposit, surveyed_deposit_, options_.deposit_threshold);
    thickness_[0].values[k] = error.rmse;
    thickness_[1].values[k] = error.bias;
  }

  const EnsembleCounts& counts_;
  const Survey& survey_;
  std::vector<double> surveyed_deposit_;
  const Options& options_;
  double cell_area_;
  Comparison comparison_;
  CellShares flow_shares_, deposit_shares_;
  std::vector<RowColumn> flow_;       // overlap of the footprint of the flow
  std::vector<RowColumn> deposit_;    // overlap of the footprint of the deposit
  std::vector<RowColumn> thickness_;  // errors of the deposit's thickness
};

/// Scores of each member on the survey's grid, whose cells are covered where a footprint covers more than half of them;
/// errors of the thickness, where it was kept, over the cells where either exceeds the threshold. Of a surveyed change
/// the cells that were released are left out of the deposit, for what lies there is no gain of height.
void add_scores(MemberRows& rows, const Ensemble& ensemble, const Survey& survey, const Options& options) {
  const EnsembleCounts& counts = ensemble.counts;
  Scores scores(counts, survey, options);
  in_threads(counts.states.size(), "scoring the members", [&](std::size_t k) {
    if (counts.states[k] == MemberState::counted) scores.score(k);
  });
  for (RowColumn& column : scores.columns()) rows.columns.push_back(std::move(column));
  if (is_probability(ensemble.table.design)) rows.share_scores = scores.of_shares();
  rows.likelihood = scores.likelihood(ensemble.table.design == design_name(Design::posterior));
}

}  // namespace

std::vector<double> comparable_deposit(const Survey& survey, const EnsembleScene& scene) {
  std::vector<double> deposit = survey.deposit;
  if (!survey.deposit_is_change || deposit.empty()) return deposit;
  const std::vector<double> released = on_grid({scene.grid, scene.release_thickness}, survey.grid);
  for (std::size_t cell = 0; cell < deposit.size(); ++cell)
    if (released[cell] > 0) deposit[cell] = nan;
  return deposit;
}

std::vector<fs::path> ensemble_files(const fs::path& out) {
  const EnsemblePaths paths{out};
  std::vector<fs::path> files = paths.found_counts();
  if (files.empty()) files.push_back(paths.counts());
  files.insert(files.begin(), paths.members());
  return files;
}

Ensemble read_ensemble(const StageContext& context) {
  Ensemble ensemble;
  ensemble.files = ensemble_files(context.out);
  ensemble.table = read_member_table(ensemble.files.front());
  judge_members(context.recipe, ensemble.files.front(), ensemble.table);
  ensemble.counts = read_parts({ensemble.files.begin() + 1, ensemble.files.end()});
  judge_counts(context, ensemble.files[1], ensemble);
  if (ensemble.counted() == 0)
    throw DataError({fmt::format("{}: no member is counted", ensemble.files[1].string()),
                     fmt::format("{} failed and {} wait", ensemble.failed(), ensemble.waiting()),
                     "See what talus-solve said of them, mend the recipe, and run it again"});
  judge_failed(ensemble_of(context.recipe), ensemble);
  tell_of_members(ensemble);
  return ensemble;
}

RunMaps base_maps(const EnsembleScene& scene) {
  RunMaps maps;
  maps.grid = scene.grid;
  maps.threshold = scene.threshold;
  maps.terrain = scene.terrain;
  maps.before = scene.before;
  maps.initial_thickness = scene.release_thickness;
  maps.deposit_thickness.assign(scene.grid.count(), 0.0);
  maps.peak_thickness = maps.deposit_thickness;
  return maps;
}

std::string member_list(const std::vector<std::int64_t>& members, std::size_t most) {
  std::string text;
  std::size_t items = 0;
  for (std::size_t k = 0; k < members.size();) {
    if (items++ == most) return text + fmt::format(" and {} more", members.size() - k);
    std::size_t end = k + 1;
    while (end < members.size() && members[end] == members[end - 1] + 1) ++end;
    const char* comma = text.empty() ? "" : ", ";
    if (end - k < 3) {
      text += fmt::format("{}{}", comma, members[k++]);
    } else {
      text += fmt::format("{}{} to {}", comma, members[k], members[end - 1]);
      k = end;
    }
  }
  return text;
}

std::string members_words(const Ensemble& ensemble) {
  const std::int64_t left_out = ensemble.counts.count(MemberState::left_out);
  return fmt::format("{} of {} members are counted, {} failed, {} wait", ensemble.counted(), ensemble.counts.members,
                     ensemble.failed(), ensemble.waiting()) +
         (left_out > 0 ? fmt::format(", {} left out", left_out) : "");
}

const char* word_of(MemberState state) {
  constexpr const char* words[] = {"waiting", "counted", "failed", "left out"};
  return words[static_cast<std::size_t>(state)];
}

MemberRows member_rows(const Ensemble& ensemble, const Options& options, const std::optional<Survey>& survey) {
  const EnsembleCounts& counts = ensemble.counts;
  const std::vector<std::string> none(counts.states.size());
  MemberRows rows{counts.states, none, none, {}, {}, {}};
  for (const MemberWords& failure : counts.failures)
    rows.failures.at(static_cast<std::size_t>(failure.member)) = failure.words;
  for (const Finding& warning : counts.findings) {
    if (warning.member == Finding::no_member || warning.severity != Severity::warning) continue;
    std::string& words = rows.warnings.at(static_cast<std::size_t>(warning.member));
    words += (words.empty() ? "" : "; ") + warning.message;
  }
  if (const auto& names = ensemble.table.names; !names.empty()) {
    RowColumn column{ColumnKind::input, "name", "", ensemble.table.slides ? "name of the slide" : "name", {}, names};
    for (std::size_t k = 0; k < names.size(); ++k) column.values.push_back(static_cast<double>(k));
    rows.columns.push_back(std::move(column));
  }
  for (const MemberColumn& column : ensemble.table.columns)
    rows.columns.push_back({ColumnKind::input, column.key, "", column.key, column.values, column.words});
  for (const ResultNumber& number : result_numbers) {
    RowColumn column{ColumnKind::result, number.name, number.unit, number.meaning, {}, {}};
    for (std::size_t k = 0; k < counts.results.size(); ++k)
      column.values.push_back(counts.states[k] == MemberState::counted ? counts.results[k].*(number.value) : nan);
    rows.columns.push_back(std::move(column));
  }
  for (const auto& [name, values] : counts.at_gauges())
    rows.columns.push_back({ColumnKind::result, name, unit_at_gauge(name), name, values, {}});
  if (survey) add_scores(rows, ensemble, *survey, options);
  return rows;
}

std::string members_csv(const MemberRows& rows, const char* called) {
  std::string text = std::string(called) + ",state";
  for (const RowColumn& column : rows.columns) text += "," + csv_field(column.name);
  text += ",failure,warnings\n";
  for (std::size_t k = 0; k < rows.states.size(); ++k) {
    text += fmt::format("{},{}", k, word_of(rows.states[k]));
    for (const RowColumn& column : rows.columns) text += "," + cell(column, k);
    text += "," + csv_field(rows.failures[k]) + "," + csv_field(rows.warnings[k]) + "\n";
  }
  return text;
}

}  // namespace talus::postprocess
