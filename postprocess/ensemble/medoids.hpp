// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Few members that stand for all: whose footprints are nearest to those of the others.
#pragma once

#include <cstdint>
#include <vector>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/footprint.hpp"

namespace talus::postprocess {

/// Jaccard distance of two footprints of one grid: 1 - common area / area of either; 0 where both are empty.
double jaccard_distance(const Footprint& a, const Footprint& b);

/// Members that stand for others.
struct Medoids {
  std::vector<std::int64_t> members;         ///< by how many they stand for, the most first
  std::vector<std::int64_t> counts;          ///< of members that each stands for, itself among them
  std::vector<std::int64_t> represented_by;  ///< [members of the ensemble]: the medoid; -1 where none was sought
  double mean_distance = 0;                  ///< of a member from its medoid
};

/// The `wanted` medoids of the flow's footprints of the first `most` counted members, by building and swapping
/// (Kaufman and Rousseeuw 1987, PAM), with Jaccard distances. Fewer where fewer footprints differ.
Medoids medoids(const EnsembleCounts& counts, std::size_t wanted, std::size_t most);

}  // namespace talus::postprocess
