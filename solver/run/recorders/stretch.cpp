#include "solver/run/recorders/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "solver/parallel/math.hpp"

namespace talus::solver {
namespace {

constexpr Column<Overstretched> stretch_columns[] = {
    {"overstretched_points", "1", [](const Overstretched& o) { return o.points; }},
    {"largest_stretch", "1", [](const Overstretched& o) { return o.largest; }},
};

/// The logarithm of the stretch from which the law's nominal stress falls; infinite where it never does.
double strain_limit(const MaterialOptions& material) {
  return visit_law(material.model, [](auto law) {
    if constexpr (requires { law.largest_strain; }) {
      return law.largest_strain;
    } else {
      return std::numeric_limits<double>::infinity();
    }
  });
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

StretchRecorder::StretchRecorder(const SolveOptions& options)
    : TableRecorder(stretch_columns, {Place{}}), limits_{strain_limit(options.material)} {
  for (const PartOptions& part : options.parts) limits_.push_back(strain_limit(part.material));
}

bool StretchRecorder::watches(const SolveOptions& options) {
  return options.any_material([](const MaterialOptions& m) { return std::isfinite(strain_limit(m)); });
}

std::vector<Overstretched> StretchRecorder::samples(const Instant& now) const {
  const ParticleState points = now.solver.shown();
  Overstretched found;
  double largest = 0;  // logarithmic
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double limit = limits_[static_cast<std::size_t>(points.material[p])];
    if (points.cell[0][p] < 0 || !std::isfinite(limit)) continue;
    const auto& e = points.elastic;
    const Sym3<double> strain{e[0][p], e[1][p], e[2][p], e[3][p], e[4][p], e[5][p]};
    // The tensor's size bounds its principal values: most points need no more than that.
    const double bar = std::min(largest, limit);
    if (norm_squared(strain) <= bar * bar) continue;
    const double principal = largest_principal(strain);
    largest = std::max(largest, principal);
    if (principal > limit) ++found.points;
  }
  found.largest = std::exp(largest);
  return {found};
}

std::vector<std::string> StretchRecorder::warnings(const RunHistory& history) const {
  const double points = most(history, "overstretched_points");
  if (!(points > 0)) return {};
  return {
      fmt::format("{:.0f} points of model = \"hencky\" were stretched by a factor of up to {:.3g}. Beyond e = 2.72 "
                  "their nominal stress falls, and what is pulled further tears. Take model = \"neo-hookean\", "
                  "whose stress grows with every stretch",
                  points, most(history, "largest_stretch"))};
}

}  // namespace talus::solver
