// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/error_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/map/slope.hpp"
#include "common/map/statistics.hpp"

namespace talus::preprocess {

namespace {

constexpr double class_deg = 10;
constexpr double the_same = 1e-3;            // [m] no survey of ground is as good
constexpr std::size_t least_in_class = 200;  // of a class: the NMAD of fewer is off by more than 7 %

struct Sample {
  double slope, misfit;
};

std::vector<Sample> samples_of(const std::vector<Patch>& patches, const std::vector<std::vector<double>>& misfits) {
  std::vector<Sample> samples;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    for (std::size_t i = 0; i < misfits[p].size(); ++i) {
      if (patches[p].unchanged[i] && !std::isnan(misfits[p][i]))
        samples.push_back({std::hypot(patches[p].slope_x[i], patches[p].slope_y[i]), misfits[p][i]});
    }
  }
  return samples;
}

std::vector<double> misfits_in(const std::vector<Sample>& samples, double from, double to) {
  std::vector<double> all;
  for (const Sample& s : samples) {
    if (s.slope >= from && s.slope < to) all.push_back(s.misfit);
  }
  return all;
}

}  // namespace

ErrorModel ErrorModel::learnt(const std::vector<Patch>& patches, const Placement& placement, double given) {
  ErrorModel model;
  std::vector<std::vector<double>> misfits;
  misfits.reserve(patches.size());
  for (const Patch& patch : patches) misfits.push_back(misfit(patch, placement));
  const std::vector<Sample> samples = samples_of(patches, misfits);
  model.given_ = given > 0;
  const auto same = [](const Sample& s) { return std::abs(s.misfit) < the_same; };
  model.same_share_ = samples.empty() ? 1.0
                                      : static_cast<double>(std::count_if(samples.begin(), samples.end(), same)) /
                                            static_cast<double>(samples.size());
  model.known_ = model.given_ || model.same_share_ < 0.5;
  model.typical_ = model.given_ ? given : model.known_ ? nmad(misfits_in(samples, 0, INFINITY)) : 0;
  for (int n = 0; n * class_deg < 90 && !model.given_ && model.known_; ++n) {
    const double deg = n * class_deg;
    const auto rise = [](double angle) { return std::tan(std::min(angle, 89.9) * std::numbers::pi / 180); };
    const std::vector<double> in_class = misfits_in(samples, rise(deg), rise(deg + class_deg));
    if (in_class.size() < least_in_class) continue;
    model.slopes_.push_back(rise(deg + class_deg / 2));
    model.sigmas_.push_back(nmad(in_class));
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    for (std::size_t i = 0; i < misfits[p].size(); ++i) {
      const double sigma = model.sigma(std::hypot(patches[p].slope_x[i], patches[p].slope_y[i]));
      misfits[p][i] =
          patches[p].unchanged[i] && sigma > 0 ? misfits[p][i] / sigma : std::numeric_limits<double>::quiet_NaN();
    }
  }
  model.variogram_ = variogram_of(patches, misfits);
  const double cell = patches.front().before.grid.cell;
  model.offset_ =
      model.typical_ * std::sqrt(model.variogram_.of_mean(static_cast<double>(samples.size()) * cell * cell, cell));
  return model;
}

ErrorModel ErrorModel::of(double given) {
  ErrorModel model;
  model.typical_ = given;
  model.given_ = model.known_ = given > 0;
  return model;
}

double ErrorModel::sigma(double slope) const {
  if (slopes_.empty() || std::isnan(slope)) return typical_;
  const auto above = std::lower_bound(slopes_.begin(), slopes_.end(), slope);
  if (above == slopes_.begin()) return sigmas_.front();
  if (above == slopes_.end()) return sigmas_.back();
  const auto k = static_cast<std::size_t>(above - slopes_.begin());
  const double t = (slope - slopes_[k - 1]) / (slopes_[k] - slopes_[k - 1]);
  return (1 - t) * sigmas_[k - 1] + t * sigmas_[k];
}

std::vector<double> ErrorModel::sigmas(const Raster& surface) const {
  std::vector<double> values;
  for (const double cosine : slope_cosine(surface))
    values.push_back(sigma(std::sqrt(std::max(0.0, 1 / (cosine * cosine) - 1))));
  return values;
}

double ErrorModel::of_mean(double mean_square, double area, double cell) const {
  if (!known_) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(mean_square * variogram_.of_mean(area, cell) + offset_ * offset_);
}

}  // namespace talus::preprocess
