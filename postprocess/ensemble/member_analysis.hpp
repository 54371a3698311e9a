// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the members of an ensemble tell: how much each key that varies moves a result, and which few stand for all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "postprocess/ensemble/ensemble.hpp"

namespace talus::postprocess {

enum class SensitivityMeasure {
  first_order,  ///< Sobol's: share of the variance that the key explains by itself (Sobol' 1993)
  total_order,  ///< likewise with all it does together with others (Homma and Saltelli 1996)
  spearman,     ///< rank correlation
  srrc,         ///< standardised coefficient of a linear regression of ranks (Iman and Conover 1979)
  hsic,         ///< R2-HSIC of ranks: dependence of any form (Da Veiga 2015)
  swing,        ///< range of the result while the key alone goes over its levels [unit of the result]
};

struct SensitivityIndex {
  std::string key;
  SensitivityMeasure measure{};
  double value = nan;
  double low = nan, high = nan;  ///< 95 % confidence; NaN where it is not known
};

/// Of one result.
struct Sensitivity {
  std::vector<SensitivityIndex> indices;
  std::int64_t members = 0;  ///< that it rests on
  std::string note;          ///< what is missing, and why; empty: nothing
};

/// The indices of a result [members], NaN where there is none. Design "sensitivity": Sobol indices by Saltelli's
/// estimators (2002), with bootstrapped confidence; the k-th member of every block is left out where one of them is
/// missing. Design "one-at-a-time": swings. Otherwise Spearman's rank correlation, with the interval of Fisher's
/// transformation and the variance 1.06 / (n - 3) (Fieller, Hartley and Pearson 1957), standardised rank regression,
/// and R2-HSIC over 250 members at most, with a note of the keys that it tells no effect of (p > 0.05). Keys that
/// take more than two words have no ranks and are left out of these. Throws std::logic_error where table and result
/// differ in their length.
Sensitivity sensitivity(const MemberTable& table, const std::vector<double>& result);

/// What a measure is called: "sobol_total" in files, "Sobol index, total" by readers.
struct MeasureWords {
  const char *name, *title;
};
const MeasureWords& measure_words(SensitivityMeasure measure);

/// Whether a result is worth its sensitivity: what the flow did, and not what the run cost.
bool has_sensitivity(const RowColumn& column);

/// The indices of all results as comma-separated values: result, key, measure, value, low, high, members.
std::string sensitivity_csv(const std::vector<std::pair<std::string, Sensitivity>>& results);

/// Jaccard distance of two footprints of one grid: 1 - common area / area of either; 0 where both are empty.
double jaccard_distance(const Footprint& a, const Footprint& b);

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
