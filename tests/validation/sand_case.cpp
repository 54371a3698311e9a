// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A3: the sand column of the reference paper, which collapses onto a rough floor.
#include <algorithm>

#include <fmt/format.h>

#include "tests/validation/sand.hpp"

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
    Chart panel = plain_chart(time == 0 ? title : "", time > 1 ? "x [m]" : "", "z [m]");
    panel.equal_scales = true;
    panel.x = Limits{-0.02, 1.0};
    panel.y = Limits{0, time == 0 ? 0.67 : time < 0.2 ? 0.58 : time < 0.4 ? 0.42 : 0.25};
    Series points = marks_of(time == 0 ? "as the gate goes" : fmt::format("{:g} s later", time), 5,
                             std::clamp(400 * s.point_spacing(), 1.2, 5.0));
    for (const auto& p : o.frames.at(frame).position) points.add(p[0], p[2]);
    panel.series.push_back(points);
    panel.series.push_back(outline_of(o, frame, s, 2));
    if (time > 1) {
      for (const Series& found : channel_laboratories("Lube et al. 2005: height, run-out", s))
        panel.series.push_back(found);
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
  Chart chart =
      plain_chart("A3: run-out over cell size, 27 points per cell", "cell size [m]", "(d end − d start) / d start");
  int colour = 1;
  std::vector<double> h;
  for (const Stepping& stepping : steppings(bench)) {
    Series line = marked_line(stepping.name, colour++);
    for (const int level : levels) {
      Sand s;
      s.h = 0.09 / (1 << level);
      s.per_cell = 3;  // with two, points of the stretched sand lie further apart than cells, and pack too densely
      const Collapse c =
          collapse(bench, fmt::format("{}, h = 0.09 / {}", stepping.name, 1 << level), s,
                   {{"solve.shape", words(stepping.shape)}, {"solve.integrator", words(stepping.integrator)}});
      line.add(s.h, c.front / s.width - 1);
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
  Series difference{study.shape, {}, {}, colour};
  for (const int per_cell : {2, 3, 4, 5}) {
    study.sand.per_cell = per_cell;
    difference.add(1.0 / per_cell, std::abs(study.explicit_reach(0.25) / most_points - 1));
  }
  return convergence(difference);
}

/// Explicit and Newmark steps, against the shortest.
std::vector<Series> reach_over_step(ReachStudy study, int colour) {
  study.sand.per_cell = 3;
  const double shortest = study.explicit_reach(0.02);
  Series by_cfl{fmt::format("{}, explicit", study.shape), {}, {}, colour};
  Series by_newmark{fmt::format("{}, newmark", study.shape), {}, {}, colour};
  for (const double step : {0.5, 0.25, 0.1, 0.05})
    by_cfl.add(step, std::abs(study.explicit_reach(step) / shortest - 1));
  for (const double step : {1.0, 3.0, 10.0, 30.0})
    by_newmark.add(step, std::abs(study.newmark_reach(step) / shortest - 1));
  Series implicit = convergence(by_newmark);
  implicit.dashed = true;
  return {convergence(by_cfl), implicit};
}

}  // namespace

/// Rows for a column on coarse cells, which fall short of what refinement leads to: eight points a cell against 27.
void coarse_column(Bench& bench, const std::string& name, Sand s) {
  double reach = nothing, centre = nothing;
  for (const int per_cell : {3, 2}) {
    s.per_cell = per_cell;
    const Outcome o =
        bench.run(fmt::format("{}, {} points a cell", name, per_cell * per_cell * per_cell), overrides_of(s));
    if (!o.ok()) continue;
    if (per_cell == 2) {
      bench.compare(o, "reach of 99 %", reach_of(o.last()), reach, 0.05);
      bench.compare(o, "centre of mass", centre_of(o.last())[0], centre, 0.05);
      bench.measure(o, "kinetic energy at the end over its peak", unrest(o), 1e-3);
    }
    reach = reach_of(o.last());
    centre = centre_of(o.last())[0];
  }
}

void sand_column(Bench& bench) {
  if (bench.coarse()) return coarse_column(bench, "h = 0.09 / 2", {.h = 0.09 / 2});
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

/// Reach of 99 % over points per cell and over the step, cells of 0.0225 m, against the most and the shortest.
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
  Chart chart = plain_chart("A3: run-out over base friction and damping, h = 0.015 m",
                            "friction coefficient of the floor", "run-out [m]");
  chart.series.push_back({"Lube et al. 2005", {0.3, 0.7}, {0.8145, 0.8145}, 0});
  int colour = 1;
  for (const double damping : {0.0, 0.05, 0.1, 0.2}) {
    Series line = marked_line(fmt::format("damping {:g}", damping), colour++);
    for (const double mu : {0.3, 0.4, 0.5, 0.55, 0.6, 0.7}) {
      Sand s;
      s.h = 0.015;
      s.per_cell = 2;
      const Outcome o =
          bench.run(fmt::format("damping {:g}, floor {:g}", damping, mu),
                    overrides_of(s) + Overrides{{"solve.damping", damping},
                                                {"solve.base.friction_angle_deg", std::atan(mu) * 180 / M_PI}});
      line.add(mu, o.ok() ? front_of(o.last(), s) : nothing);
      bench.note(o, "run-out [m]", line.y.back());
    }
    chart.series.push_back(line);
  }
  bench.picture("A3-friction", png_of(chart));
}

namespace {

/// The column of an aspect ratio on cells of about a `cells`th of its height, a whole number across (walls at nodes).
Sand column_of(double aspect, double cells) {
  Sand s;
  s.height = aspect * s.width;
  s.h = s.width / static_cast<double>(std::max(1L, std::lround(cells / aspect)));
  return s;
}

/// One column on cells that are halved twice: its run-outs (d end - d start) / d start, and its profiles.
struct HalvedCells {
  static constexpr int levels = 3;
  std::vector<double> run_outs;
  std::vector<Series> profiles;
  Outcome finest;

  /// Where the run-outs lead, as errors of first order fall (Richardson 1911): the toe is a wedge.
  double limit() const { return run_outs.size() < levels ? nothing : 2 * run_outs[levels - 1] - run_outs[levels - 2]; }

  /// Rows: the run-out of each grid for the eye, its limit by `band`, and what the first halving moves.
  void judge(Bench& bench, const Band& band) const {
    for (std::size_t n = 0; n < run_outs.size(); ++n)
      bench.note(finest, fmt::format("run-out over width, cells halved {} times", n), run_outs[n]);
    bench.within(finest, "run-out over width, extrapolated", limit(), band);
    bench.measure(finest, "run-out moved by halving the coarsest cells",
                  run_outs.size() < 2 ? nothing : (1 + run_outs[1]) / (1 + run_outs[0]) - 1, 0.04);
    if (profiles.size() == levels)
      bench.note(finest, "profile that the last halving moves, over height",
                 profile_difference(profiles[levels - 2], profiles[levels - 1]));
  }
};

/// The profiles of columns of some aspect ratios, one panel each.
class ProfilePicture {
 public:
  explicit ProfilePicture(std::string x_label) : x_label_(std::move(x_label)) {}

  void add(double aspect, const HalvedCells& column, const std::vector<Series>& laboratories) {
    if (column.profiles.size() < HalvedCells::levels) return;
    Chart panel = plain_chart(fmt::format("aspect ratio {:g}", aspect), x_label_, "z [m]");
    panel.equal_scales = true;
    double far = 0, high = 0;
    panel.series = column.profiles;
    const char* names[] = {"computed", "cells half as large", "a quarter as large"};
    for (std::size_t n = 0; n < HalvedCells::levels; ++n) {
      panel.series[n].name = names[n];
      panel.series[n].dashed = n + 1 < HalvedCells::levels;
    }
    panel.series.insert(panel.series.end(), laboratories.begin(), laboratories.end());
    for (const Series& s : panel.series) {
      for (const double x : s.x) far = std::isfinite(x) ? std::max(far, x) : far;
      for (const double y : s.y) high = std::isfinite(y) ? std::max(high, y) : high;
    }
    panel.x = Limits{-0.02 * far, 1.05 * far};
    panel.y = Limits{0, std::max(1.6 * high, 0.2 * far)};  // with room for the legend
    panels_.push_back(panel);
  }
  std::string png() const { return png_of_panels(panels_); }

 private:
  std::string x_label_;
  std::vector<Chart> panels_;
};

constexpr int profile_colours[HalvedCells::levels] = {5, 4, 2};

/// Columns of one aspect ratio with 16, 32 and 64 cells along the height.
HalvedCells plane_column(Bench& bench, double aspect) {
  HalvedCells column;
  Sand s = column_of(aspect, 16);
  s.per_cell = 2;
  for (int level = 0; level < HalvedCells::levels; ++level) {
    column.finest = bench.run(fmt::format("a = {:g}, h = {:.2g} mm", aspect, 1000 * s.h), overrides_of(s));
    const Outcome& o = column.finest;
    if (!o.ok()) break;
    column.run_outs.push_back(run_out_of(o, s));
    column.profiles.push_back(outline_of(o, o.frames.size() - 1, s, profile_colours[level]));
    const Band height = band_of(lube_height(aspect), lajeunesse_height(aspect));
    if (level + 1 == HalvedCells::levels) bench.within(o, "height over width", height_of(o, s), height);
    s.h /= 2;
  }
  column.judge(bench, band_of(lube_run_out(aspect), lajeunesse_run_out(aspect)));
  return column;
}

/// The front of a quarter of a round deposit, over the distance from the axis.
double front_of_quarter(Points points, const Sand& s) {
  for (auto& p : points.position) p = {std::hypot(p[0], p[1]), 0, p[2]};
  return front_of(points, s.h, [](double radius) { return std::numbers::pi / 2 * radius; });
}

}  // namespace

Overrides round_column(const Sand& s) {
  constexpr int strips = 16;
  const double wide = s.width / strips, reach = s.width * (1 + 1.5 * round_run_out(s.height / s.width));
  const long columns = std::lround(reach / s.h) + 8;
  Overrides all = grid_of(s.h, s.per_cell) + Overrides{{"preprocess.laboratory.cells[0]", whole(columns)},
                                                       {"preprocess.laboratory.cells[1]", whole(columns)}};
  for (int n = 0; n < strips; ++n) {
    const double y = (n + 0.5) / strips, east = wide * std::round(strips * std::sqrt(1 - y * y));
    const std::string box = fmt::format("preprocess.box[{}].", n);
    all = all + Overrides{{box + "name", words(fmt::format("strip {}", n + 1))},
                          {box + "extent_m", std::vector<double>{0, n * wide, east, (n + 1) * wide, 0, s.height}}};
  }
  return all;
}

void sand_column_aspects(Bench& bench) {
  if (bench.coarse()) return coarse_column(bench, "a = 1, 4 cells", column_of(1, 4));
  Chart chart = log_chart("A3b: run-out over aspect ratio, one set of parameters", "aspect ratio, height over width",
                          "(d end − d start) / d start");
  const auto draw = [](const std::string& name, double (*law)(double), double first, double step, int count) {
    Series line{name, {}, {}, 0};
    for (int n = 0; n < count; ++n) {
      line.x.push_back(first + n * step);
      line.y.push_back(law(line.x.back()));
    }
    return line;
  };
  Series ours = marks_of("computed, extrapolated from 16, 32 and 64 cells along the height", 2, 10);
  ProfilePicture pictures("x [m]");
  for (const double aspect : {0.5, 1.0, 1.5, 3.0, 5.0, 7.0, 9.0}) {
    const HalvedCells column = plane_column(bench, aspect);
    if (aspect == 0.5 || aspect == 1 || aspect == 3 || aspect == 7)
      pictures.add(aspect, column, channel_laboratories("Lube et al. 2005", column_of(aspect, 16)));
    ours.add(aspect, column.limit());
  }
  Series wide = draw("Lajeunesse et al. 2005", lajeunesse_run_out, 0.4, 0.1, 90);
  wide.colour = 3;
  chart.series = {draw("Lube et al. 2005", lube_run_out, 0.4, 0.1, 14), draw("", lube_run_out, 2.81, 0.5, 14), wide,
                  ours};
  bench.picture("A3b-run-out", png_of(chart));
  bench.picture("A3b-profiles", pictures.png());
}

/// Round columns, as a quarter between two rollers; run-out and height by the laws of one laboratory.
void round_sand_columns(Bench& bench) {
  ProfilePicture pictures("distance from the axis [m]");
  for (const double aspect : {0.5, 1.0, 2.0, 4.0}) {
    HalvedCells column;
    Sand s = column_of(aspect, 8 * std::max(1.0, aspect));
    s.per_cell = 2;
    for (int level = 0; level < HalvedCells::levels; ++level) {
      column.finest =
          bench.run(fmt::format("a = {:g}, h = radius / {}", aspect, std::lround(s.width / s.h)), round_column(s));
      const Outcome& o = column.finest;
      if (!o.ok()) break;
      column.run_outs.push_back(front_of_quarter(o.last(), s) / s.width - 1);
      column.profiles.push_back(outline_of_quarter(o.last(), s, profile_colours[level]));
      const Band height = band_of(round_height(aspect), nothing);
      if (level + 1 == HalvedCells::levels && std::isfinite(height.low))
        bench.within(o, "height over radius", height_of(o, s), height);
      s.h /= 2;
    }
    column.judge(bench, band_of(round_run_out(aspect), nothing));
    pictures.add(aspect, column,
                 {laboratory("Lube et al. 2004", Sand{}, round_run_out(aspect), round_height(aspect), 1)});
  }
  bench.picture("A3c-profiles", pictures.png());
}

}  // namespace talus::validation
