// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A3b and A3c: sand columns of other aspect ratios, in a slice and round.
#include <fmt/format.h>

#include <algorithm>

#include "tests/validation/sand_deposit.hpp"

namespace talus::validation {
namespace {

/// The column of an aspect ratio on cells of about a `cells`th of its height: a whole number of them across the column,
/// since walls stand on nodes.
Sand column_of(double aspect, double cells) {
  Sand s;
  s.height = aspect * s.width;
  s.h = s.width / static_cast<double>(std::max(1L, std::lround(cells / aspect)));
  return s;
}

/// Two profiles, on coarse and on fine cells, and what they are held against.
struct Profiles {
  Series coarse, fine;
  std::vector<Series> laboratories;
};

/// The profiles of columns of some aspect ratios, one panel each.
class ProfilePicture {
 public:
  explicit ProfilePicture(std::string x_label) : x_label_(std::move(x_label)) {}

  void add(double aspect, Profiles p) {
    if (p.coarse.x.empty() || p.fine.x.empty()) return;
    Chart panel;
    panel.title = fmt::format("aspect ratio {:g}", aspect);
    panel.x_label = x_label_;
    panel.y_label = "z [m]";
    panel.equal_scales = true;
    double far = 0, high = 0;
    p.coarse.name = "computed";
    p.coarse.dashed = true;
    p.fine.name = "computed, cells half as large";
    panel.series = {p.coarse, p.fine};
    panel.series.insert(panel.series.end(), p.laboratories.begin(), p.laboratories.end());
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

/// Columns of one aspect ratio with 16 cells along the height and 32, and what halving the cells moves.
Collapse halved(Bench& bench, double aspect, Profiles& profiles) {
  Collapse result;
  double before = nothing;
  Series& coarse = profiles.coarse;
  for (const bool finer : {false, true}) {
    Sand s = column_of(aspect, 16);
    if (finer) s.h /= 2;
    result = collapse(bench, fmt::format("a = {:g}, h = {:.2g} mm", aspect, 1000 * s.h), s, {});
    const bool ran = result.outcome.ok();
    if (ran)
      (finer ? profiles.fine : coarse) = outline_of(result.outcome, result.outcome.frames.size() - 1, s, finer ? 2 : 4);
    if (finer) {
      bench.measure(result.outcome, "run-out that halving the cells moves", result.front / before - 1, 0.03);
      if (ran && !coarse.x.empty())
        bench.note(result.outcome, "profile moved over height", profile_difference(coarse, profiles.fine));
    }
    before = result.front;
  }
  const Sand s = column_of(aspect, 16);
  profiles.laboratories = {
      laboratory("Lube et al. 2005", s, lube_run_out(aspect), lube_height(aspect), 1),
      laboratory("Lajeunesse et al. 2005", s, lajeunesse_run_out(aspect), lajeunesse_height(aspect), 3)};
  return result;
}

/// A quarter of a round column from strips of a sixteenth of its radius along y, each as far along x as the circle,
/// rounded to a sixteenth as well.
Overrides round_column(const Sand& s) {
  constexpr int strips = 16;
  const double wide = s.width / strips, reach = s.width * (1 + 1.5 * round_run_out(s.height / s.width));
  const long columns = std::lround(reach / s.h) + 8;
  Overrides all{{"preprocess.grid.spacing_m", s.h},
                {"preprocess.grid.points_per_cell", std::vector<std::int64_t>(3, s.per_cell)},
                {"preprocess.laboratory.cells[0]", whole(columns)},
                {"preprocess.laboratory.cells[1]", whole(columns)},
                {"preprocess.laboratory.corner_m[0]", -3.5 * s.h},
                {"preprocess.laboratory.corner_m[1]", -3.5 * s.h}};
  for (int n = 0; n < strips; ++n) {
    const double y = (n + 0.5) / strips, east = wide * std::round(strips * std::sqrt(1 - y * y));
    const std::string box = fmt::format("preprocess.box[{}].", n);
    all = all + Overrides{{box + "name", words(fmt::format("strip {}", n + 1))},
                          {box + "extent_m", std::vector<double>{0, n * wide, east, (n + 1) * wide, 0, s.height}}};
  }
  return all;
}

/// The points with their distance from the axis for x.
Points by_radius(Points points) {
  for (auto& p : points.position) p = {std::hypot(p[0], p[1]), 0, p[2]};
  return points;
}

}  // namespace

/// A square column on four cells, as short of where refinement leads as A3's coarse one.
void coarse_aspect(Bench& bench) {
  Sand s = column_of(1, 4);
  s.per_cell = 3;
  const Outcome o = bench.run("a = 1, 4 cells", overrides_of(s));
  bench.compare(o, "run-out over width", o.ok() ? front_of(o.last(), s) / s.width - 1 : nothing, 0.81, 0.08);
  bench.compare(o, "height over width", o.ok() ? top_of(o.last(), s) / s.width : nothing, 0.945, 0.05);
}

void sand_column_aspects(Bench& bench) {
  if (bench.coarse()) return coarse_aspect(bench);
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
  Series ours{"computed, some 32 cells along the height", {}, {}, 2};
  ours.line = false;
  ours.marks = true;
  ours.mark_size = 10;
  ProfilePicture pictures("x [m]");
  for (const double aspect : {0.5, 1.0, 1.5, 3.0, 5.0, 7.0, 9.0}) {
    Profiles profiles;
    const Collapse c = halved(bench, aspect, profiles);
    if (aspect == 0.5 || aspect == 1 || aspect == 3 || aspect == 7) pictures.add(aspect, profiles);
    ours.x.push_back(aspect);
    ours.y.push_back(c.front / Sand{}.width - 1);
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
    const Band run_out = band_of(round_run_out(aspect), nothing), height = band_of(round_height(aspect), nothing);
    double before = nothing;
    Profiles profiles{{}, {}, {laboratory("Lube et al. 2004", Sand{}, round_run_out(aspect), round_height(aspect), 1)}};
    for (const double cells : {8.0, 16.0}) {
      Sand s = column_of(aspect, static_cast<int>(std::lround(cells * std::max(1.0, aspect))));
      s.per_cell = s.h > s.width / 8 ? 4 : 3;
      if (std::lround(s.width / s.h) % 16 != 0) s.per_cell = 4;
      const Outcome o =
          bench.run(fmt::format("a = {:g}, h = radius / {}", aspect, std::lround(s.width / s.h)), round_column(s));
      const double front = o.ok() ? front_of(by_radius(o.last()), s) / s.width - 1 : nothing;
      bench.within(o, "run-out over radius", front, run_out.low, run_out.high);
      if (std::isfinite(height.low))
        bench.within(o, "height over radius", o.ok() ? top_of(o.last(), s) / s.width : nothing, height.low,
                     height.high);
      if (std::isfinite(before))
        bench.measure(o, "run-out that halving the cells moves", (1 + front) / (1 + before) - 1, 0.03);
      before = front;
      if (o.ok()) (cells < 16 ? profiles.coarse : profiles.fine) = outline_of_quarter(o.last(), s, cells < 16 ? 4 : 2);
    }
    pictures.add(aspect, profiles);
  }
  bench.picture("A3c-profiles", pictures.png());
}

}  // namespace talus::validation
