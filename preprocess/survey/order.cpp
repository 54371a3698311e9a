// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/order.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/map/sum.hpp"
#include "common/stage/findings.hpp"

namespace talus::preprocess {

namespace {

constexpr double tells = 0.1;   // of what fell: less that rose has no say in where mass went
constexpr double swells = 2.0;  // what fell loosens by 1.2 to 1.5; more than twice as much has come from elsewhere

}  // namespace

Order order_of(const Change& change, const std::vector<Region>& sure, const Raster& before) {
  Sum volume[2], moment[2];
  for (const Region& region : sure) {
    for (const std::size_t c : region.cells) {
      const double rise = change.rise.values[c];
      const int side = rise > 0;
      volume[side].add(std::abs(rise));
      moment[side].add(std::abs(rise) * (before.values[c] + rise / 2));
    }
  }
  const double area = before.grid.cell * before.grid.cell;
  const auto height = [&](int side) {
    return volume[side].value() > 0 ? moment[side].value() / volume[side].value() : 0;
  };
  return {volume[1].value() * area, volume[0].value() * area, height(1), height(0)};
}

std::optional<Fault> wrong_order(const Order& o, const SurveyFiles& files) {
  const bool uphill = o.fall > 0 && o.rise > tells * o.fall && o.rise_height > o.fall_height,
             from_nowhere = o.rise > swells * o.fall;
  if (!uphill && !from_nowhere) return std::nullopt;
  const std::string what =
      fmt::format("{}: {} m3 rose above {}, {} m3 fell", files.after, grouped(o.rise), files.before, grouped(o.fall));
  const std::string why =
      uphill ? fmt::format(
                   "what rose lies {:.1f} m higher than what fell (at {:.1f} and {:.1f} m on average), and mass "
                   "goes down",
                   o.rise_height - o.fall_height, o.rise_height, o.fall_height)
             : fmt::format("more than {:g} times as much rose as fell, and mass comes from somewhere", swells);
  return Fault{what, why,
               std::string("Is before_dem the later one? Then swap before_dem and after_dem") +
                   (files.aligned ? "" : ". Is one too high? Then mode = \"apply\" in [preprocess.coregistration]")};
}

void judge_order(const Order& order, const SurveyFiles& files) {
  if (const auto wrong = wrong_order(order, files))
    refuse_unless_accepted("swapped-surveys", *wrong, {{"rise", order.rise, "m3"}, {"fall", order.fall, "m3"}});
}

}  // namespace talus::preprocess
