// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/gis.hpp"

#include <chrono>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <sstream>

#include <fmt/format.h>

#include "postprocess/fields/styles.hpp"
#include "postprocess/maps/netcdf.hpp"

namespace talus::postprocess {
namespace {

constexpr std::size_t most_frames = 60;  // a layer each: more of them open slowly

/// The thickest of all frames decides on the classes, which all of them share.
RasterStyle flow_style(const Run& run, const std::vector<double>& given) {
  std::vector<double> thickest{0};
  for (const auto& frame : run.frames.thickness)
    for (const double h : frame)
      if (h > thickest[0]) thickest[0] = h;
  return class_style(thickness_limits(given, thickest), "m");
}

}  // namespace

std::string instant_after(const std::string& start, double seconds) {
  using namespace std::chrono;
  std::tm begin{};
  std::istringstream(start) >> std::get_time(&begin, "%Y-%m-%d %H:%M:%S");
  const sys_days date{year{begin.tm_year + 1900} / (begin.tm_mon + 1) / begin.tm_mday};
  const auto at = sys_time<milliseconds>(date) + hours{begin.tm_hour} + minutes{begin.tm_min} +
                  std::chrono::seconds{begin.tm_sec} + milliseconds{std::llround(1000 * seconds)};
  const auto midnight = floor<days>(at);
  const year_month_day civil{midnight};
  const hh_mm_ss clock{at - midnight};
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(civil.year()),
                     static_cast<unsigned>(civil.month()), static_cast<unsigned>(civil.day()), clock.hours().count(),
                     clock.minutes().count(), clock.seconds().count(), clock.subseconds().count());
}

std::vector<std::size_t> shown_frames(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t shown = std::min(count, most);
  for (std::size_t k = 0; k < shown; ++k)
    chosen.push_back(shown < 2 ? 0 : (k * (count - 1) + (shown - 1) / 2) / (shown - 1));
  return chosen;
}

ProjectGroup flow_group(const Run& run, const Options& options) {
  ProjectGroup group{"Flow over time (Temporal Controller)", {}, false};
  const auto& time = run.frames.time;
  const auto chosen = shown_frames(time.size(), most_frames);
  if (chosen.size() < 2) return group;
  const std::string start = options.start_time.empty() ? nominal_start : options.start_time;
  RasterStyle style = flow_style(run, options.classes);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const bool last = k + 1 == chosen.size();
    const double begin = time[chosen[k]];
    const double end = last ? begin + (begin - time[chosen[k - 1]]) : time[chosen[k + 1]];
    style.band = static_cast<int>(chosen[k]) + 1;
    group.layers.push_back({fmt::format("Thickness at {:g} s [m]", begin), "NETCDF:\"results.nc\":thickness", true,
                            style, ProjectTime{instant_after(start, begin), instant_after(start, end)}});
  }
  return group;
}

}  // namespace talus::postprocess
