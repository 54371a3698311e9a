// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/inflow_section.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace talus::solver {

InflowSection::InflowSection(InflowGround ground, const InflowOptions& options)
    : ground_(std::move(ground)),
      sorted_(ground_.height),
      speed_(options.speed),
      depth_(options.depth),
      froude_(options.froude) {
  std::sort(sorted_.begin(), sorted_.end());
}

double InflowSection::along() const { return std::sqrt(1 + ground_.slope * ground_.slope); }

SectionFlow InflowSection::filled_to(double level) const {
  SectionFlow flow{.level = level};
  for (const double height : sorted_) {
    if (!(height < level)) break;
    flow.area += (level - height) * ground_.strip;
    flow.width += ground_.strip;
  }
  flow.depth = std::max(0.0, level - sorted_.front());
  return flow;
}

/// The method raises the surface strip by strip until the area is reached.
SectionFlow InflowSection::filled_by(double area) const {
  double sum = 0;
  for (std::size_t n = 1; n <= sorted_.size(); ++n) {
    sum += sorted_[n - 1];
    const auto count = static_cast<double>(n);
    const double level = (area / ground_.strip + sum) / count;
    if (n == sorted_.size() || level <= sorted_[n]) return filled_to(level);
  }
  return {};
}

/// The method halves the range of levels: what passes grows with the level.
SectionFlow InflowSection::critical(double discharge, double froude) const {
  // u along the ground is Fr sqrt(g cos h_n), h_n = cos A / B; horizontally it is cos times as much.
  const double cosine = 1 / along(), factor = froude * cosine * cosine * std::sqrt(ground_.gravity);
  const auto passes = [&](const SectionFlow& f) {
    return f.width > 0 ? factor * f.area * std::sqrt(f.area / f.width) : 0.0;
  };
  double low = 0, high = ground_.strip;
  while (passes(filled_by(high)) < discharge) high *= 2;
  for (int halvings = 0; halvings < 200 && high - low > 1e-15 * high; ++halvings) {
    const double middle = 0.5 * (low + high);
    (passes(filled_by(middle)) < discharge ? low : high) = middle;
  }
  return filled_by(high);
}

SectionFlow InflowSection::flow(double discharge) const {
  SectionFlow flow;
  if (speed_) {
    flow = filled_by(discharge * along() / *speed_);
  } else if (depth_) {
    flow = filled_to(sorted_.front() + *depth_);
  } else {
    flow = critical(discharge, *froude_);
  }
  flow.speed = discharge / flow.area;
  return flow;
}

std::vector<double> InflowSection::thickness(const SectionFlow& flow) const {
  std::vector<double> thickness;
  for (const double height : ground_.height) thickness.push_back(std::max(0.0, flow.level - height));
  return thickness;
}

double InflowSection::froude(const SectionFlow& flow) const {
  const double cosine = 1 / along();
  return flow.speed * along() / (cosine * std::sqrt(ground_.gravity * flow.area / flow.width));
}

}  // namespace talus::solver
