// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/pace.hpp"

#include <algorithm>
#include <utility>

#include <tbb/global_control.h>

namespace talus {
namespace {

thread_local bool works_alone = false;

}  // namespace

Alone::Alone() : before_(std::exchange(works_alone, true)) {}
Alone::~Alone() { works_alone = before_; }
bool Alone::here() { return works_alone; }

}  // namespace talus

namespace talus::detail {
namespace {

constexpr int loops_of_a_trial = 4;
constexpr double fading = 0.9;      // of the weight of earlier loops, with each
constexpr double trial_share = 16;  // a trial comes after so many times what it costs
constexpr long longest_interval = 4096;

}  // namespace

bool LoopPace::next_alone() {
  if (trial_ == 0 && --until_trial_ <= 0) trial_ = loops_of_a_trial;
  return trial_ > 0 ? !usually_alone_ : usually_alone_;
}

void LoopPace::note(double seconds, double items) {
  const bool was_alone = trial_ > 0 ? !usually_alone_ : usually_alone_;
  Times& times = was_alone ? alone_ : together_;
  times.seconds = fading * times.seconds + seconds;
  times.items = fading * times.items + items;
  if (trial_ == 0 || --trial_ > 0) return;
  const double usual = (usually_alone_ ? alone_ : together_).each(), other = times.each();
  if (other < usual) {
    usually_alone_ = !usually_alone_;
    interval_ = 64;
  } else {
    const double ratio = usual > 0 ? other / usual : 1;
    interval_ = std::max(std::min(2 * interval_, longest_interval),
                         static_cast<long>(std::min(trial_share * loops_of_a_trial * ratio, 1e9)));
  }
  until_trial_ = interval_;
  (usually_alone_ ? together_ : alone_) = {};  // the next trial stands for itself
}

bool is_single_threaded() {
  return Alone::here() || tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism) == 1;
}

}  // namespace talus::detail
