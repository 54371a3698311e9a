// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far a share of the members may be off the probability that it estimates.
#pragma once

#include <cstdint>
#include <string>

#include "common/ensemble/member_table.hpp"

namespace talus::postprocess {

/// Standard error of a share of `draws` independent members: half the width of Wilson's score interval at z = 1
/// (68.3 %), sqrt(p q n + 1/4) / (n + 1) (Wilson 1927; Brown, Cai and DasGupta 2001, equation 4). Unlike sqrt(p q / n)
/// it does not vanish where no member, or every member, says yes.
double standard_error(double share, double draws);

/// The number of independent members for which that error would be half of what it is with `draws`, the share being
/// the same: the root of sqrt(p q m + 1/4) / (m + 1) = e / 2.
double members_to_halve(double share, double draws);

/// For how many independent draws the counted members stand at least. A design of Sobol indices has d + 2 blocks of
/// sample_size members; each block is an independent sample, but blocks share values, so that the error of the mean
/// over all of them is at most that of one block (the triangle inequality of standard deviations).
double independent_draws(const MemberTable& table, std::int64_t counted);

/// What a share of the members of a design is, and what its error means: a sentence each.
struct ShareWords {
  std::string meaning, error;
};
ShareWords share_words(const std::string& design);

/// Whether a share of the members estimates a probability.
bool is_probability(const std::string& design);

}  // namespace talus::postprocess
