// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a survey that lie higher or lower than its rest: tiles, strips and halves of a mosaic.
#pragma once

#include <filesystem>
#include <vector>

#include "preprocess/survey/patches.hpp"

namespace talus::preprocess {

/// A part of the map where the difference of two surveys is another plane than around it.
struct ShiftedPart {
  std::vector<std::size_t> cells;  ///< of the patch's grid
  double step = 0;                 ///< median height of its edge, after less before; below 0: the part lies lower [m]
  bool at_rim = false;             ///< it is cut by the rim of the ground that both surveys hold
};

/// The shifted parts of a patch, the later survey at `placement`, the largest first. The difference is taken as the
/// median of 3 x 3 cells; its noise s as the NMAD of the differences three cells apart, over the root of 2 (which steps
/// and slides do not raise), at least 1 cm. Its levels are the middles of the densest windows of 4 s, the first one of
/// the whole, each next one of what lies further than 4 s from those before. A part is a connected region beyond 4 s
/// from the first level, or within 4 s of a later one, of 200 cells and a hundredth of the map at least, which
/// - has half of its edge on even lines, or one that takes half of its way from rim to rim of the map: a straight line
///   with 20 sides of cells of the edge and 15 % of all within one cell, those sides of it counted at which the step,
///   from one cell inside to three outside, keeps to the line's median, or to a trend that does not triple it, by a
///   quarter, and at which the difference is as level four and six cells inside, which is three cells deep at least,
///   and six outside. A circle has no such line, an ellipse three times as long as wide has two of 40 %; scars and
///   deposits go on sloping;
/// - has a median step there of 6 s at least;
/// - is cut by the rim, or leaves what rose and what fell elsewhere nearer to balance than they are with it;
/// - is not level in both surveys (is_level()), as a lake is whose water fell.
std::vector<ShiftedPart> shifted_parts(const Patch& patch, const Placement& placement);

/// Refuses, unless accepted ("shifted-part"), two surveys with a shifted part, with its place, step and area. Looked
/// for with and without the tilt of the placement, which a step may have caused.
void judge_shifted_parts(const std::vector<Patch>& patches, const Placement& placement,
                         const std::filesystem::path& after_file);

}  // namespace talus::preprocess
