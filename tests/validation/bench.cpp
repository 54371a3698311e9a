// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/bench.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/recipe/toml.hpp"
#include "common/run/hdf5.hpp"
#include "common/stage/stage.hpp"

namespace talus::validation {
namespace {

struct Columns {
  std::vector<double> position;
  std::vector<float> velocity, volume, pressure;
  std::vector<std::int32_t> id;
};

Columns read_columns(const h5::File& file) {
  const auto whole = [&](const std::string& name, auto kind) {
    return file.read<decltype(kind)>("/VTKHDF/" + name, file.dims("/VTKHDF/" + name));
  };
  return {whole("Points", 0.0), whole("PointData/velocity", 0.0F), whole("PointData/volume", 0.0F),
          whole("PointData/pressure", 0.0F), whole("PointData/id", std::int32_t{})};
}

Points frame_of(const Columns& c, std::size_t first, std::size_t count, std::size_t points) {
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  Points frame;
  frame.position.assign(points, {nowhere, nowhere, nowhere});
  frame.velocity.assign(points, {});
  frame.volume.assign(points, 0);
  frame.pressure.assign(points, 0);
  std::vector<bool> taken(points);
  for (std::size_t p = first; p < first + count; ++p) {
    auto at = static_cast<std::size_t>(c.id[p]);
    if (taken[at])
      at = frame.add();
    else
      taken[at] = true;
    for (std::size_t a = 0; a < 3; ++a) {
      frame.position[at][a] = c.position[3 * p + a];
      frame.velocity[at][a] = c.velocity[3 * p + a];
    }
    frame.volume[at] = c.volume[p];
    frame.pressure[at] = c.pressure[p];
  }
  return frame;
}

/// x [m] and volume [m3] of the points that are in the domain, by x.
std::vector<std::pair<double, double>> along_x(const Points& points) {
  std::vector<std::pair<double, double>> parts;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (std::isfinite(points.position[p][0])) parts.emplace_back(points.position[p][0], points.volume[p]);
  std::sort(parts.begin(), parts.end());
  return parts;
}

}  // namespace

std::size_t Points::add() {
  position.emplace_back();
  velocity.emplace_back();
  volume.push_back(0);
  pressure.push_back(0);
  return size() - 1;
}

std::vector<Points> read_points(const std::filesystem::path& run) {
  const auto file = h5::File::open(run, {run, "Run talus-solve again"});
  if (!file.exists("/VTKHDF/Steps/Values")) return {};
  const auto times = file.read<double>("/VTKHDF/Steps/Values", file.dims("/VTKHDF/Steps/Values"));
  const auto counts = file.read<std::int64_t>("/VTKHDF/NumberOfPoints", file.dims("/VTKHDF/NumberOfPoints"));
  const Columns columns = read_columns(file);
  const auto last = std::max_element(columns.id.begin(), columns.id.end());
  const std::size_t points = last == columns.id.end() ? 0 : static_cast<std::size_t>(*last) + 1;
  std::vector<Points> frames;
  std::size_t first = 0;
  for (std::size_t f = 0; f < times.size(); ++f) {
    const auto count = static_cast<std::size_t>(counts.at(f));
    frames.push_back(frame_of(columns, first, count, points));
    frames.back().time = times[f];
    first += count;
  }
  return frames;
}

std::array<double, 3> centre_of(const Points& points) {
  std::array<double, 3> sum{};
  double all = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto volume = static_cast<double>(points.volume[p]);
    for (std::size_t a = 0; a < 3; ++a) sum[a] += volume * points.position[p][a];
    all += volume;
  }
  return {sum[0] / all, sum[1] / all, sum[2] / all};
}

double front_of(const Points& points, double cell, const std::function<double(double)>& breadth) {
  const auto parts = along_x(points);
  double front = std::numeric_limits<double>::quiet_NaN(), volume = 0;
  for (std::size_t last = 0, first = 0; last < parts.size(); ++last) {
    const double x = parts[last].first;
    volume += parts[last].second;
    while (parts[first].first < x - cell) volume -= parts[first++].second;
    if (volume > front_thickness * cell * breadth(x)) front = x;
  }
  return front;
}

double reach_of(const Points& points) {
  const auto parts = along_x(points);
  double all = 0, so_far = 0;
  for (const auto& part : parts) all += part.second;
  for (const auto& [x, volume] : parts) {
    so_far += volume;
    if (so_far > 0.99 * all) return x;
  }
  return parts.back().first;
}

long cost_bound(long recorded) { return std::lround(std::ceil(1.15 * static_cast<double>(recorded))) + 2; }

CostBook read_costs(const std::filesystem::path& file) {
  CostBook book;
  if (!std::filesystem::exists(file)) return book;
  try {
    const toml::table table = toml::parse_file(file.string());
    for (const auto& [run, value] : table) {
      const toml::array* numbers = value.as_array();
      long found[3] = {-1, -1, -1};
      for (std::size_t n = 0; numbers && numbers->size() == 3 && n < 3; ++n)
        found[n] = static_cast<long>(numbers->get(n)->value_or<std::int64_t>(-1));
      if (found[0] < 0 || found[1] < 0 || found[2] < 0)
        throw std::runtime_error(
            fmt::format("{}: \"{}\" is not [steps, Newton iterations, linear iterations]. "
                        "talus-validate --record-costs writes such lines",
                        file.string(), std::string(run.str())));
      book[std::string(run.str())] = {found[0], found[1], found[2]};
    }
  } catch (const toml::parse_error& error) {
    throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), error.source().begin.line, error.description()));
  }
  return book;
}

std::string as_toml(const CostBook& book) {
  std::string text =
      "# What the runs of the validation have cost: steps, Newton iterations, linear iterations. A run may cost 15 % "
      "and\n"
      "# two more; rows of the table say so. Written by talus-validate --record-costs, which keeps the runs that it "
      "does\n"
      "# not make.\n";
  for (const auto& [run, cost] : book)
    text += fmt::format("\"{}\" = [{}, {}, {}]\n", run, cost.steps, cost.newton, cost.linear);
  return text;
}

namespace {

namespace fs = std::filesystem;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();

/// Runs a program with its stderr in `log`; returns its exit code.
int call(const std::vector<std::string>& words, const fs::path& log) {
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  pid_t child = 0;
  const int failed = posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error(words[0] + ": cannot be started; build the programs first (make build)");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string last_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line, last;
  while (std::getline(stream, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

/// A count of the history, 0 where there is none.
long whole_or_none(double value) { return std::isfinite(value) ? std::lround(value) : 0; }

/// "quadratic, h = 50 / 4" as a folder: quadratic-h-50-4.
std::string folder_of(const std::string& variant) {
  std::string folder;
  for (const char c : variant) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_';
    if (kept) folder += c;
    if (!kept && !folder.empty() && folder.back() != '-') folder += '-';
  }
  while (!folder.empty() && folder.back() == '-') folder.pop_back();
  return folder;
}

}  // namespace

std::vector<double> Outcome::history(const std::string& name) const {
  const HistoryColumn* column = run.history.find(name);
  return column ? column->values : std::vector<double>{};
}

double Outcome::last_of(const std::string& name) const {
  const auto column = history(name);
  return column.empty() ? unknown : column.back();
}

fs::path Bench::folder(const std::string& variant) const { return request_.out / name_ / folder_of(variant); }

std::string Bench::run_stages(const std::string& variant, const Overrides& overrides, bool profile) const {
  const fs::path out = folder(variant), recipe = out / "recipe.toml";
  fs::remove_all(out);
  fs::create_directories(out);
  const std::string text = recipe_with(request_.recipes / name_.substr(0, name_.find('-')) / "recipe.toml", overrides);
  const bool measures_points = text.find("point_frames") == std::string::npos;
  write_text(recipe, text);
  fmt::print(stderr, "{:4} {:44} ", name_, variant);
  std::fflush(stderr);
  for (const char* stage : {"talus-preprocess", "talus-solve"}) {
    const fs::path log = out / (std::string(stage) + ".log");
    std::vector<std::string> words{(request_.programs / stage).string(), recipe.string(), "--out", out.string(), "-q"};
    const bool solves = stage == std::string("talus-solve");
    if (solves) words.insert(words.end(), {"--on", request_.on});
    if (solves && measures_points) words.insert(words.end(), {"--set", "solve.point_frames=exact"});
    if (solves && profile) words.emplace_back("--profile");
    const int code = call(words, log);
    if (interrupted()) throw Interrupted({"stopped", "interrupted", "Run it again"});
    if (code == 0) continue;
    std::string fault = fmt::format("exit code {}: {}", code, last_line(log));
    fmt::print(stderr, "{}\n", fault);
    return fault;
  }
  return {};
}

Outcome Bench::run(const std::string& variant, const Overrides& overrides, bool profile) {
  Outcome outcome;
  outcome.variant = variant;
  outcome.fault = run_stages(variant, overrides, profile);
  if (!outcome.ok()) return outcome;
  outcome.run = read_run(folder(variant) / "run.h5");
  outcome.frames = read_points(folder(variant) / "run.h5");
  fmt::print(stderr, "{:8.1f} s\n", outcome.run.summary.wall_time);
  judge_cost(outcome);
  return outcome;
}

MembersOutcome Bench::run_members(const std::string& variant, const Overrides& overrides) {
  const auto begun = std::chrono::steady_clock::now();
  MembersOutcome o;
  o.outcome.variant = variant;
  o.outcome.fault = run_stages(variant, overrides, false);
  if (!o.outcome.ok()) return o;
  const EnsemblePaths paths{folder(variant)};
  o.table = read_member_table(paths.members());
  o.counts = read_counts(paths.counts());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  fmt::print(stderr, "{:8.1f} s\n", seconds);
  return o;
}

Row Bench::row_of(const Outcome& outcome, const std::string& quantity) const {
  Row row{};
  row.name = outcome.variant.empty() ? name_ : name_ + " " + outcome.variant;
  row.quantity = quantity;
  row.fault = outcome.fault;
  row.wall_time = row.particles = row.steps = row.newton = row.cg = row.over_cfl = unknown;
  if (!outcome.ok() || outcome.run.summary.particles == 0) return row;
  const RunSummary& s = outcome.run.summary;
  row.wall_time = s.wall_time;
  row.particles = static_cast<double>(s.particles);
  row.steps = static_cast<double>(s.steps);
  row.newton = outcome.last_of("newton_iterations");
  row.cg = outcome.last_of("linear_iterations");
  row.over_cfl = outcome.last_of("step_over_cfl");
  row.place = s.on;
  return row;
}

void Bench::judge(const Outcome& outcome, const std::string& quantity, double computed, const Claim& claim) {
  Row row = row_of(outcome, quantity);
  row.computed = outcome.ok() ? computed : unknown;
  row.reference = claim.reference;
  row.error = outcome.ok() ? claim.error : unknown;
  row.tolerance = claim.tolerance;
  row.lowest = claim.lowest;
  row.highest = claim.highest;
  row.judged = true;
  row.pass = outcome.ok() && std::isfinite(claim.error) && claim.error <= claim.tolerance;
  keep_(row);
}

void Bench::compare(const Outcome& outcome, const std::string& quantity, double computed, double reference,
                    double tolerance) {
  const double error = reference == 0 ? std::abs(computed) : std::abs(computed / reference - 1);
  judge(outcome, quantity, computed, {reference, error, tolerance, reference, reference});
}

void Bench::at_least(const Outcome& outcome, const std::string& quantity, double computed, double reference) {
  const double error = std::isfinite(computed) ? std::max(0.0, reference - computed) : unknown;
  judge(outcome, quantity, computed, {reference, error, 0, reference, endless});
}

void Bench::at_most(const Outcome& outcome, const std::string& quantity, double computed, double reference) {
  judge(outcome, quantity, computed, {reference, std::max(0.0, computed / reference - 1), 0, -endless, reference});
}

void Bench::within(const Outcome& outcome, const std::string& quantity, double computed, const Band& band,
                   double tolerance) {
  const double nearer = std::abs(computed - band.low) < std::abs(computed - band.high) ? band.low : band.high;
  const double error = computed >= band.low && computed <= band.high ? 0 : std::abs(computed / nearer - 1);
  judge(outcome, quantity, computed, {nearer, error, tolerance, band.low, band.high});
}

void Bench::note(const Outcome& outcome, const std::string& quantity, double computed) {
  Row row = row_of(outcome, quantity);
  row.computed = outcome.ok() ? computed : unknown;
  row.reference = row.tolerance = row.error = row.lowest = row.highest = unknown;
  keep_(row);
}

void Bench::judge_cost(const Outcome& outcome) {
  const std::string run = row_of(outcome, "").name;
  const Cost cost{static_cast<long>(outcome.run.summary.steps), whole_or_none(outcome.last_of("newton_iterations")),
                  whole_or_none(outcome.last_of("linear_iterations"))};
  costs_[run] = cost;
  const auto known = request_.costs.find(run);
  if (known == request_.costs.end()) return;
  const auto judge_count = [&](const char* what, long count, long recorded) {
    if (recorded > 0 || count > 0)
      at_most(outcome, what, static_cast<double>(count), static_cast<double>(cost_bound(recorded)));
  };
  judge_count("cost: steps", cost.steps, known->second.steps);
  judge_count("cost: Newton iterations", cost.newton, known->second.newton);
  judge_count("cost: linear iterations", cost.linear, known->second.linear);
}

void Bench::picture(const std::string& name, const std::string& png) const {
  const fs::path path = request_.out / (name + ".png");
  write_text(path, png);
  fmt::print(stderr, "     {}\n", path.string());
}

}  // namespace talus::validation
