// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/sampling_error.hpp"

#include <cmath>

namespace talus::postprocess {

double standard_error(double share, double draws) {
  return std::sqrt(share * (1 - share) * draws + 0.25) / (draws + 1);
}

double members_to_halve(double share, double draws) {
  const double pq = share * (1 - share), e = standard_error(share, draws);
  return (pq + std::sqrt(pq * pq + e * e * (0.25 - pq))) / (0.5 * e * e) - 1;  // (e m / 2)^2 = pq m + 1/4 - pq, less 1
}

double independent_draws(const MemberTable& table, std::int64_t counted) {
  const auto members = static_cast<double>(counted);
  if (table.sample_size <= 0 || table.count <= 0) return members;
  return members * static_cast<double>(table.sample_size) / static_cast<double>(table.count);
}

bool is_probability(const std::string& design) {
  return design != "slides" && design != "budget" && design != "one-at-a-time" && design != "table" &&
         design != "full-grid";
}

ShareWords share_words(const std::string& design) {
  const std::string given = "Share of the counted members: the probability, given the distributions in [ensemble].";
  if (design == "one-at-a-time")
    return {"Share of the counted members. They vary one key at a time: this is no probability.",
            "The error that as many independent draws would have; it says nothing of this design."};
  if (design == "full-grid")
    return {"Share of the counted members, which are all combinations of equally probable values of each key.",
            "The error that as many independent draws would have; a grid's own error depends on its levels."};
  if (design == "slides")
    return {"Share of the counted slides. They are different slides and not draws of one: this is no probability.",
            "Slides are no sample, so their share has no sampling error."};
  if (design == "table")
    return {"Share of the counted members, which a table lists: a probability only where its rows were drawn from one.",
            "The error that as many independent draws would have."};
  if (design == "sensitivity")
    return {given, "Standard error of one of the design's blocks of independent draws: an upper bound of the error."};
  if (design == "monte-carlo") return {given, "Standard error of the share."};
  return {given, "Standard error of as many independent draws; a stratified design usually has a smaller one."};
}

}  // namespace talus::postprocess
