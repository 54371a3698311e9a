// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/stage/findings.hpp"

namespace talus::solver {
namespace {

constexpr Column<Overstretched> stretch_columns[] = {
    {"overstretched_points", "1", [](const Overstretched& o) { return o.points; }},
    {"points_apart", "1", [](const Overstretched& o) { return o.apart; }},
    {"largest_stretch", "1", [](const Overstretched& o) { return o.largest; }},
};

/// The least stretch that counts as parting, where points lie a cell apart from the start.
constexpr double least_parting = 1.2;

constexpr const char* why_torn =
    "the grid hardly ties them together there, and the body may part where no strength says so";

std::string torn_words(double points, double stretch) {
  return fmt::format(
      "{:.0f} points of an elastic body were stretched by a factor of up to {:.3g}, to more than {:g} of a cell from "
      "the next",
      points, stretch, StretchRecorder::widest_spacing);
}

double largest_principal(const Sym3<double>& strain) {
  double values[3];
  Mat3<double> axes;
  eigen_symmetric(strain, values, axes);
  return std::max({values[0], values[1], values[2]});
}

double most(const RunHistory& history, const char* column) {
  const std::vector<double>& values = history.at(column).values;
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

}  // namespace

StretchRecorder::Limits StretchRecorder::limits_of(const MaterialOptions& material) {
  return visit_law(material.model, [](auto law) {
    Limits limits{law.keeps_strain && !law.stiffness_is_free, std::numeric_limits<double>::infinity()};
    if constexpr (requires { law.largest_strain; }) limits.largest_strain = law.largest_strain;
    return limits;
  });
}

StretchRecorder::StretchRecorder(const SolveOptions& options, const Scene& scene)
    : TableRecorder(stretch_columns, {Place{}}),
      limits_{limits_of(options.material)},
      cell_volume_(scene.grid.spacing * scene.grid.spacing * scene.grid.layer_height),
      accepts_torn_(options.shape != ShapeKind::gimp && std::ranges::count(options.accept, torn_body) > 0),
      bears_gaps_(options.shape == ShapeKind::gimp || accepts_torn_) {
  for (const PartOptions& part : options.parts) limits_.push_back(limits_of(part.material));
}

bool StretchRecorder::watches(const SolveOptions& options) {
  return options.any_material([](const MaterialOptions& m) { return limits_of(m).elastic; });
}

std::vector<Overstretched> StretchRecorder::samples(const Instant& now) const {
  const ParticleState points = now.solver.shown();
  Overstretched found;
  double largest = 0;  // logarithmic
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Limits& limits = limits_[points.material_of(p)];
    if (points.cell[0][p] < 0 || !limits.elastic) continue;
    const auto& e = points.elastic;
    const Sym3<double> strain{e[0][p], e[1][p], e[2][p], e[3][p], e[4][p], e[5][p]};
    const double parts = std::log(std::max(least_parting, widest_spacing * std::cbrt(cell_volume_ / points.volume[p])));
    // The tensor's size bounds its principal values: most points need no more than that.
    const double bar = std::max(0.0, std::min({largest, limits.largest_strain, parts}));
    if (norm_squared(strain) <= bar * bar) continue;
    const double principal = largest_principal(strain);
    largest = std::max(largest, principal);
    if (principal > limits.largest_strain) ++found.points;
    if (principal > parts) ++found.apart;
  }
  found.largest = std::exp(largest);
  if (found.apart > 0 && !bears_gaps_) refuse_torn(found, now.time);
  return {found};
}

void StretchRecorder::refuse_torn(const Overstretched& found, double time) const {
  throw NumericalError(
      {fmt::format("t = {:.6g} s: {}", time, torn_words(found.apart, found.largest)), why_torn,
       fmt::format(
           "Take more points_per_cell, or shape = \"gimp\", whose boxes stretch with the points; or insist with "
           "[solve] accept = [\"{}\"]",
           torn_body)});
}

void StretchRecorder::conclude(const RunHistory& history) const {
  const double points = most(history, "overstretched_points"), apart = most(history, "points_apart");
  const double largest = most(history, "largest_stretch");
  if (points > 0)
    warn("overstretched",
         fmt::format("{:.0f} points of model = \"hencky\" were stretched by a factor of up to {:.3g}. Beyond e = 2.72 "
                     "their nominal stress falls, and what is pulled further tears. Take model = \"neo-hookean\", "
                     "whose stress grows with every stretch",
                     points, largest),
         {{"points", points, "1"}, {"stretch", largest, "1"}});
  if (apart > 0)
    warn("points-apart",
         fmt::format("{:.0f} points were stretched by a factor of up to {:.3g}, to more than {:g} of a cell from the "
                     "next. There the grid hardly ties them together, and the body may part where no strength says "
                     "so. Take more points_per_cell, or shape = \"gimp\"; the energies of the history show a tear as "
                     "a fall",
                     apart, largest, widest_spacing),
         {{"points", apart, "1"}, {"stretch", largest, "1"}});
  if (apart > 0 && accepts_torn_)
    refuse_unless_accepted(torn_body, {torn_words(apart, largest), why_torn, ""}, {{"points", apart, "1"}});
}

}  // namespace talus::solver
