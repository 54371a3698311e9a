// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of twice the spacing as sums of those of one (T20; subdivision, Lane & Riesenfeld 1980), one direction at a
// time. Spaces are nested, so that a coarse displacement is one of the fine grid, to the digit.
#pragma once

#include "solver/parallel/macros.hpp"

namespace talus::solver {

/// The relation between functions of one grid and those of the next, along one direction.
struct TwoScale {
  /// Which functions double their spacing: none (`same`), hats or quadratic splines.
  enum Kind { same, hats, splines } kind = same;

  /// The number of coarse functions over so many fine ones.
  TALUS_HD int count(int fine) const { return kind == same ? fine : kind == hats ? fine / 2 + 1 : fine / 2 + 2; }

  /// In (T20), coarse function c is the sum of weight(n) times fine function first(c) + n, n < children(), as far as
  /// that is there.
  TALUS_HD int children() const { return kind == same ? 1 : kind == hats ? 3 : 4; }
  /// The number of the first fine function in a coarse one.
  TALUS_HD int first(int coarse) const {
    return kind == same ? coarse : kind == hats ? 2 * coarse - 1 : 2 * coarse - 3;
  }
  /// The weight of a fine function in a coarse one, `child` counted from 0.
  TALUS_HD double weight(int child) const {
    if (kind == same) return 1;
    if (kind == hats) return child == 1 ? 1 : 0.5;
    return child == 0 || child == 3 ? 0.25 : 0.75;
  }

  /// The coarse functions that a fine one is part of, and its weights in them, which add up to 1. Returns how many
  /// there are.
  TALUS_HD int parents(int fine, int (&coarse)[2], double (&weights)[2]) const {
    const int half = fine / 2;
    const bool odd = fine % 2 != 0;
    if (kind == same || (kind == hats && !odd)) {
      coarse[0] = kind == same ? fine : half;
      weights[0] = 1;
      return 1;
    }
    coarse[0] = kind == hats ? half : half + 1;
    coarse[1] = kind == hats || !odd ? (kind == hats ? half + 1 : half) : half + 2;
    weights[0] = kind == hats ? 0.5 : 0.75;
    weights[1] = kind == hats ? 0.5 : 0.25;
    return 2;
  }
};

}  // namespace talus::solver
