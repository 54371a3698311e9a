// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A3: the sand column of the reference paper, which collapses onto a rough floor.
#include <fmt/format.h>

#include <algorithm>

#include "tests/validation/sand_deposit.hpp"

namespace talus::validation {
namespace {

std::size_t frame_at(const Outcome& o, double time) {
  const auto nearest = std::min_element(o.frames.begin(), o.frames.end(), [&](const Points& a, const Points& b) {
    return std::abs(a.time - time) < std::abs(b.time - time);
  });
  return static_cast<std::size_t>(nearest - o.frames.begin());
}

/// The column before the gate goes and at the times of the paper's Fig. 12, one panel each.
std::string outlines(const Outcome& o, const Sand& s, const std::string& title) {
  std::vector<Chart> panels;
  for (const double time : {0.0, 0.15, 0.3, 0.6, 1.2}) {
    const std::size_t frame = frame_at(o, gate_opens + time);
    Chart panel;
    panel.title = time == 0 ? title : "";
    panel.y_label = "z [m]";
    panel.equal_scales = true;
    panel.x = Limits{-0.02, 1.0};
    panel.y = Limits{0, time == 0 ? 0.67 : time < 0.2 ? 0.58 : time < 0.4 ? 0.42 : 0.25};
    Series points{time == 0 ? "as the gate goes" : fmt::format("{:g} s later", time), {}, {}, 5};
    for (const auto& p : o.frames.at(frame).position) {
      points.x.push_back(p[0]);
      points.y.push_back(p[2]);
    }
    points.line = false;
    points.marks = true;
    points.mark_size = std::clamp(400 * s.point_spacing(), 1.2, 5.0);
    panel.series.push_back(points);
    panel.series.push_back(outline_of(o, frame, s, 2));
    if (time > 1) {
      panel.x_label = "x [m]";
      const double aspect = s.height / s.width;
      panel.series.push_back(
          laboratory("Lube et al. 2005: height, run-out", s, lube_run_out(aspect), lube_height(aspect), 1));
      panel.series.push_back(
          laboratory("Lajeunesse et al. 2005", s, lajeunesse_run_out(aspect), lajeunesse_height(aspect), 3));
    }
    panels.push_back(panel);
  }
  return png_of_panels(panels);
}

/// Kinetic energy of the last record over the largest one.
double unrest(const Outcome& o) {
  const auto kinetic = o.history("kinetic_J");
  if (kinetic.empty()) return nothing;
  return kinetic.back() / *std::max_element(kinetic.begin(), kinetic.end());
}

/// A line at one height over a range of cells.
Series level_line(const std::string& name, const std::vector<double>& h, double value, int colour) {
  return {name, {h.back(), h.front()}, {value, value}, colour};
}

/// Functions and steps.
struct Stepping {
  const char* name;
  const char* shape;
  const char* integrator;
  const char* picture;  ///< of its finest cells
};
std::vector<Stepping> steppings(const Bench& bench) {
  std::vector<Stepping> list{{"quadratic", "quadratic", "explicit", "A3-outlines-quadratic"},
                             {"linear", "linear", "explicit", "A3-outlines-linear"}};
  if (bench.complete())
    list.push_back({"quadratic, column-implicit", "quadratic", "column-implicit", "A3-outlines-by-columns"});
  return list;
}

void refinement(Bench& bench, const std::vector<int>& levels) {
  Chart chart;
  chart.title = "A3: run-out over cell size, 27 points per cell";
  chart.x_label = "cell size [m]";
  chart.y_label = "(d end − d start) / d start";
  int colour = 1;
  std::vector<double> h;
  for (const Stepping& stepping : steppings(bench)) {
    Series line{stepping.name, {}, {}, colour++};
    line.marks = true;
    for (const int level : levels) {
      Sand s;
      s.h = 0.09 / (1 << level);
      s.per_cell = 3;  // with two, points of the stretched sand lie further apart than cells, and pack too densely
      const Collapse c =
          collapse(bench, fmt::format("{}, h = 0.09 / {}", stepping.name, 1 << level), s,
                   {{"solve.shape", words(stepping.shape)}, {"solve.integrator", words(stepping.integrator)}});
      line.x.push_back(s.h);
      line.y.push_back(c.front / s.width - 1);
      if (level == levels.back() && c.outcome.ok()) {
        bench.picture(stepping.picture,
                      outlines(c.outcome, s, fmt::format("A3: sand column, {}, h = {:g} m", stepping.name, s.h)));
      }
    }
    h = line.x;
    chart.series.push_back(line);
  }
  chart.series.push_back(level_line("Lube et al. 2005", h, lube_run_out(7), 0));
  chart.series.push_back(level_line("Lajeunesse et al. 2005", h, lajeunesse_run_out(7), 3));
  bench.picture("A3-convergence", png_of(chart));
}

/// How far 99 % of the sand get with one kind of functions, on cells of 0.0225 m.
struct ReachStudy {
  Bench& bench;
  const char* shape;
  Sand sand;

  double reach(const std::string& name, const Overrides& more) const {
    const Outcome o = bench.run(fmt::format("{}, {}", shape, name),
                                overrides_of(sand) + Overrides{{"solve.shape", words(shape)}} + more);
    const double x = o.ok() ? reach_of(o.last()) : nothing;
    bench.note(o, "reach of 99 % [m]", x);
    return x;
  }
  double explicit_reach(double cfl) const {
    const int points = sand.per_cell * sand.per_cell * sand.per_cell;
    return reach(fmt::format("{} points per cell, explicit, {:g} CFL", points, cfl), {{"solve.cfl", cfl}});
  }
  double newmark_reach(double over_cfl) const {
    constexpr double cfl_step = 4.27e-4;  // cell over the wave speed and the square root of three [s]
    return reach(fmt::format("newmark, {:g} CFL", over_cfl), {{"solve.integrator", words("newmark")},
                                                              {"solve.implicit.step_s", over_cfl * cfl_step},
                                                              {"solve.implicit.newton_tolerance", 1e-4},
                                                              {"solve.implicit.linear_tolerance", 1e-3}});
  }
};

/// Against the most points.
Series reach_over_points(ReachStudy study, int colour) {
  study.sand.per_cell = 7;
  const double most_points = study.explicit_reach(0.25);
  std::vector<double> spacing, difference;
  for (const int per_cell : {2, 3, 4, 5}) {
    study.sand.per_cell = per_cell;
    spacing.push_back(1.0 / per_cell);
    difference.push_back(std::abs(study.explicit_reach(0.25) / most_points - 1));
  }
  return convergence(study.shape, spacing, difference, colour);
}

/// Explicit and Newmark steps, against the shortest.
std::vector<Series> reach_over_step(ReachStudy study, int colour) {
  study.sand.per_cell = 3;
  const double shortest = study.explicit_reach(0.02);
  std::vector<double> cfl, by_step, over_cfl, by_implicit_step;
  for (const double step : {0.5, 0.25, 0.1, 0.05}) {
    cfl.push_back(step);
    by_step.push_back(std::abs(study.explicit_reach(step) / shortest - 1));
  }
  for (const double step : {1.0, 3.0, 10.0, 30.0}) {
    over_cfl.push_back(step);
    by_implicit_step.push_back(std::abs(study.newmark_reach(step) / shortest - 1));
  }
  Series implicit = convergence(fmt::format("{}, newmark", study.shape), over_cfl, by_implicit_step, colour);
  implicit.dashed = true;
  return {convergence(fmt::format("{}, explicit", study.shape), cfl, by_step, colour), implicit};
}

}  // namespace

/// The column on cells of half its width, which fall short of the laboratories' band by five cells: what they give, to
/// more than the order of sums moves (2 %) and less than another scheme would.
void coarse_column(Bench& bench) {
  Sand s;
  s.h = 0.09 / 2;
  s.per_cell = 3;
  const Outcome o =
      bench.run("quadratic, h = 0.09 / 2", overrides_of(s) + Overrides{{"solve.shape", words("quadratic")}});
  bench.compare(o, "run-out over width", o.ok() ? front_of(o.last(), s) / s.width - 1 : nothing, 5.17, 0.08);
  bench.compare(o, "height over width", o.ok() ? top_of(o.last(), s) / s.width : nothing, 2.23, 0.05);
  bench.measure(o, "kinetic energy at the end over its peak", unrest(o), 1e-3);
}

void sand_column(Bench& bench) {
  if (bench.coarse()) return coarse_column(bench);
  refinement(bench, bench.complete() ? std::vector<int>{1, 2, 3, 4} : std::vector<int>{1, 2});
}

/// The paper's grid with 64 points per cell, in steps of each kind.
void sand_column_paper(Bench& bench) {
  const Sand s;
  for (const char* integrator : {"explicit", "column-implicit", "newmark"}) {
    const Collapse c = collapse(bench, fmt::format("{}, h = 0.01 m, 64 per cell", integrator), s,
                                {{"solve.integrator", words(integrator)}});
    bench.measure(c.outcome, "kinetic energy at the end over its peak", unrest(c.outcome), 1e-6);
    if (c.outcome.ok()) {
      bench.picture(fmt::format("A3-outlines-{}-0.01", integrator),
                    outlines(c.outcome, s, fmt::format("A3: sand column, {}, h = 0.01 m", integrator)));
    }
  }
}

/// Reach of 99 % over points per cell and over the step, cells of 0.0225 m: against the most points and the shortest
/// steps.
void sand_column_studies(Bench& bench) {
  Chart points = log_chart("A3: reach over points per cell, h = 0.0225 m", "distance of the points over cell size",
                           "difference of the reach of 99 % to 343 points per cell");
  Chart steps = log_chart("A3: reach over the step, h = 0.0225 m, 27 points per cell", "step over the CFL step",
                          "difference of the reach of 99 % to explicit steps of 0.02 CFL");
  int colour = 1;
  for (const char* shape : {"quadratic", "gimp", "linear"}) {
    Sand s;
    s.h = 0.09 / 4;
    const ReachStudy study{bench, shape, s};
    points.series.push_back(reach_over_points(study, colour));
    for (const Series& line : reach_over_step(study, colour)) steps.series.push_back(line);
    ++colour;
  }
  bench.picture("A3-points", png_of(points));
  bench.picture("A3-steps", png_of(steps));
}

/// Run-out over damping and base friction (the paper's Fig. 13a).
void sand_column_friction(Bench& bench) {
  Chart chart;
  chart.title = "A3: run-out over base friction and damping, h = 0.015 m";
  chart.x_label = "friction coefficient of the floor";
  chart.y_label = "run-out [m]";
  chart.series.push_back({"Lube et al. 2005", {0.3, 0.7}, {0.8145, 0.8145}, 0});
  int colour = 1;
  for (const double damping : {0.0, 0.05, 0.1, 0.2}) {
    Series line{fmt::format("damping {:g}", damping), {}, {}, colour++};
    line.marks = true;
    for (const double mu : {0.3, 0.4, 0.5, 0.55, 0.6, 0.7}) {
      Sand s;
      s.h = 0.015;
      s.per_cell = 2;
      const Outcome o =
          bench.run(fmt::format("damping {:g}, floor {:g}", damping, mu),
                    overrides_of(s) + Overrides{{"solve.damping", damping},
                                                {"solve.base.friction_angle_deg", std::atan(mu) * 180 / M_PI}});
      line.x.push_back(mu);
      line.y.push_back(o.ok() ? front_of(o.last(), s) : nothing);
      bench.note(o, "run-out [m]", line.y.back());
    }
    chart.series.push_back(line);
  }
  bench.picture("A3-friction", png_of(chart));
}

}  // namespace talus::validation
