// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-bench: what steps cost, and time against error. Checks what it times; writes CSV and pictures.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <map>

#include "common/error.hpp"
#include "common/stage/stage.hpp"
#include "pipelines/benchmarks/kernels.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/validation/chart.hpp"

namespace {

using namespace talus;
namespace fs = std::filesystem;
using benchmarks::KernelRun;
using benchmarks::KernelSetting;
using solver::Precision;

struct Words {
  std::string set, on = "auto";
  fs::path out = "out";
  std::string only;
  double least = 0, most = 0;
};

Words parse(int argc, char** argv) {
  CLI::App app("Time steps and kernels on a block of sand, from 1e4 points on; check what is timed.", "talus-bench");
  Words w;
  app.add_option("set", w.set, "What to time")->required()->check(CLI::IsMember({"kernels"}));
  app.add_option("--on", w.on, "Where")
      ->type_name("auto|cpu|gpu|gpus")
      ->check(CLI::IsMember({"auto", "cpu", "gpu", "gpus"}));
  app.add_option("--out", w.out, "Folder for CSV and pictures");
  app.add_option("--most", w.most, "Largest number of points (default: 1e4 on a CPU, 1e7 on a GPU)");
  app.add_option("--least", w.least, "Smallest number of points");
  app.add_option("--only", w.only,
                 "Rows that contain this, of \"METHOD SHAPE PRECISION\", as in \"explicit quadratic\"");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  return w;
}

/// The commit of this program, "1a2b3c4"; empty where it was built without one.
std::string commit() {
  const std::string words = version();
  const auto open = words.find('('), close = words.find(')');
  return open < close && close != std::string::npos ? words.substr(open + 1, close - open - 1) : "";
}

std::string csv_of(const std::vector<KernelRun>& runs, double copy) {
  std::string text =
      "method,shape,precision,place,points,steps,step_us,seconds_per_point_and_step,bytes_per_point,newton_iterations_"
      "per_step,newton_iteration_us,cg_iterations_per_step,seconds_per_point_and_cg_iteration,momentum_error,phases_us,"
      "kernels_us_and_share_of_copy,memory_bytes_per_point,commit,date\n";
  const std::string made = fmt::format("{},{:%Y-%m-%d}", commit(), fmt::gmtime(std::time(nullptr)));
  const auto join = [](const auto& list, auto&& word) {
    std::string all;
    for (const auto& item : list) all += (all.empty() ? "" : "; ") + word(item);
    return all;
  };
  for (const KernelRun& r : runs) {
    const double iterations = r.cg_iterations;
    std::vector<KernelRun::Kernel> longest(
        r.kernels.begin(),
        r.kernels.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(r.kernels.size(), 12)));
    text += fmt::format(
        "{},{},{},{},{:.0f},{},{:.3f},{:.4g},{:.1f},{:.1f},{},{:.1f},{},{:.2g},\"{}\",\"{}\",\"{}\",{}\n", r.method,
        r.shape, r.precision, r.place, r.points, r.steps, 1e6 * r.step_seconds, r.eta(), r.bytes / r.points,
        r.newton_iterations, iterations > 0 ? fmt::format("{:.1f}", 1e6 * r.newton_seconds()) : "", iterations,
        iterations > 0 ? fmt::format("{:.3g}", r.seconds_of("conjugate gradients") / iterations / r.points) : "",
        r.check, join(r.phases, [](const auto& p) { return fmt::format("{}: {:.2f}", p.first, 1e6 * p.second); }),
        join(longest,
             [&](const auto& k) {
               return fmt::format("{}: {:.2f}", k.name, 1e6 * k.seconds) +
                      (k.bytes > 0 ? fmt::format(" {:.0f} %", 100 * k.bytes / k.seconds / copy) : "");
             }),
        join(r.memory, [&](const auto& m) { return fmt::format("{}: {:.0f}", m.first, m.second / r.points); }), made);
  }
  return text;
}

/// One quantity over the number of points, a line for each way of stepping.
template <class Quantity>
std::string picture(const std::string& title, const std::string& label, const std::vector<KernelRun>& runs,
                    Quantity&& quantity) {
  validation::Chart chart = validation::log_chart(title, "material points", label);
  std::map<std::string, validation::Series> lines;
  for (const KernelRun& r : runs) {
    const std::string name = fmt::format("{}, {}, {}", r.method, r.shape, r.precision);
    auto& line =
        lines.try_emplace(name, validation::Series{name, {}, {}, static_cast<int>(lines.size()) + 1}).first->second;
    line.marks = true;
    line.x.push_back(r.points);
    line.y.push_back(quantity(r));
  }
  for (auto& [name, line] : lines) chart.series.push_back(line);
  return validation::png_of(chart);
}

/// The settings that rows are timed with: methods, shapes and precisions whose name contains `only`.
std::vector<KernelSetting> settings_of(const std::string& only) {
  std::vector<KernelSetting> settings;
  for (const bool newmark : {false, true})
    for (const auto shape : {ShapeKind::linear, ShapeKind::quadratic})
      for (const auto precision : {Precision::single_, Precision::double_}) {
        const KernelSetting setting{newmark, shape, precision, 0};
        if (newmark && precision == Precision::single_) continue;
        if (benchmarks::name_of(setting).find(only) != std::string::npos) settings.push_back(setting);
      }
  return settings;
}

/// The numbers of points that a setting is timed with, half a power of ten apart from 1e4 on.
std::vector<double> numbers_of_points(const KernelSetting& setting, double least, double most) {
  if (setting.newmark) most = std::min(most, 1.1e6);
  if (setting.precision == Precision::double_) most = std::min(most, 3.3e7);
  std::vector<double> numbers;
  for (int half_powers = 8;; ++half_powers) {
    const double points = std::pow(10.0, 0.5 * half_powers);
    if (points > most * 1.001) return numbers;
    if (points * 1.1 >= least) numbers.push_back(points);
  }
}

std::string line_of(const KernelRun& r) {
  return fmt::format(
      "{:8} {:9} {:6} {:9.0f} points {:10.1f} us a step {:9.3g} s a point and step {:6.0f} B a point{}\n", r.method,
      r.shape, r.precision, r.points, 1e6 * r.step_seconds, r.eta(), r.bytes / r.points,
      r.pass ? "" : fmt::format("  WRONG: momentum off by {:.2g}", r.check));
}

int kernels(const Words& words, On on) {
  const double most = words.most > 0 ? words.most : on == On::cpu ? 1e4 : 1e7;
  const double copy = on == On::cpu ? copy_bandwidth(CpuDevice::make()) : copy_bandwidth(GpuDevice::make());
  std::vector<KernelRun> runs;
  bool pass = true;
  for (KernelSetting setting : settings_of(words.only))
    for (const double points : numbers_of_points(setting, words.least, most)) {
      setting.points = points;
      try {
        runs.push_back(benchmarks::time_kernels(setting, on));
      } catch (const NumericalError& error) {
        fmt::print(stderr, "{:.0f} points: {}\n", points, error.what());
        pass = false;
        break;
      }
      pass = pass && runs.back().pass;
      fmt::print(stderr, "{}", line_of(runs.back()));
      write_text(words.out / "kernels.csv", csv_of(runs, copy));
    }
  if (runs.empty())
    throw RecipeError({"no row of the bench contains \"" + words.only + "\" between --least and --most", "", ""});
  write_text(words.out / "kernels-time.png",
             picture("Time per point and step, " + runs.front().place, "time per point and step [s]", runs,
                     [](const KernelRun& r) { return r.eta(); }));
  write_text(words.out / "kernels-memory.png", picture("Memory of points, grid and solver, " + runs.front().place,
                                                       "memory [B]", runs, [](const KernelRun& r) { return r.bytes; }));
  return pass ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const Words words = parse(argc, argv);
  try {
    fs::create_directories(words.out);
    return kernels(words, solver::choose_device(*on_called(words.on)));
  } catch (const std::exception& error) {
    fmt::print(stderr, "talus-bench: {}\n", error.what());
    return 2;
  }
}
