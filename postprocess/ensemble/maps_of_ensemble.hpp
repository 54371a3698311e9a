// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of an ensemble, hazard classes among them: one list for GeoTIFF, NetCDF, QGIS and the page; what they say of
// the ensemble, and how far a share of its members may be off a probability.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/ensemble/member_table.hpp"
#include "common/gis/geotiff.hpp"
#include "common/qgis/style.hpp"
#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// What a hazard map is made of: the counts by which it goes.
struct HazardRule {
  std::size_t tally = 0;                ///< of counted_maps
  std::vector<std::size_t> thresholds;  ///< places of the intensity limits among those counted
  std::vector<double> intensity;        ///< limits, rising [unit of the map]
  std::vector<double> probability;      ///< lower limits of the classes, rising
  std::vector<int> matrix;              ///< class by intensity (from weak) and probability (from rare), row by row
};

/// The rule of the recipe; empty where it names no limits and the usual ones are not among the counted, and of slides,
/// whose shares are no probabilities. Throws DataError where the recipe names limits that were not counted.
std::optional<HazardRule> hazard_rule(const Ensemble& ensemble, const HazardOptions& options);

/// The matrix as one sentence for metadata: "peak pressure of 3 kPa or more: 1 from 0.01, 1 from 0.1, 2 from 0.5; ...".
std::string hazard_words(const HazardRule& rule);

enum class EnsembleMapKind {
  share,      ///< of the members that pass a threshold
  error,      ///< its standard error
  to_halve,   ///< number of members that would halve that
  quantile,   ///< value that a share of the members does not exceed
  mean,       ///< over the members
  deviation,  ///< likewise
  hazard,     ///< class by probability and intensity
  count,      ///< number of members that pass a threshold
  largest,    ///< largest value of any member; of a time the smallest
};

/// One of them; its values are made when they are asked for.
struct EnsembleMap {
  EnsembleMapKind kind{};
  std::size_t tally = 0;      ///< of counted_maps
  std::size_t threshold = 0;  ///< share, error, to_halve: place among the thresholds
  double level = nan;         ///< the threshold itself [unit of the counted map], or the share of a quantile
  std::string name;           ///< of its file: "peak_thickness_above_0.5_m"
  std::string title;          ///< "Probability of peak thickness of 0.5 m or more"
  std::string unit;           ///< in UDUNITS' words
};

/// The shares of which there are quantile maps.
inline constexpr double quantile_shares[] = {0.05, 0.5, 0.95};

/// "peak thickness", "arrival time".
std::string words_of(const CountedMap& map);

/// "m/s" of "m s-1".
std::string unit_words(const std::string& unit);

/// "0.5 m or more", "60 s or less".
std::string threshold_words(const CountedMap& map, double threshold);

/// All maps of an ensemble, by quantity. A hazard map is among them where its limits are counted.
std::vector<EnsembleMap> ensemble_maps(const Ensemble& ensemble, const HazardOptions& hazard);

/// The values of a map where counts are kept, by place, and its value everywhere else.
struct KeptValues {
  std::vector<double> values;
  double elsewhere = nan;
};
KeptValues kept_values(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard);

/// The values of a map [rows * columns]; NaN outside the domain, and of a time where too few members arrive.
std::vector<double> values_of(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard);

/// The class limits of a map, by its values; and how QGIS draws it.
std::vector<double> limits_of(const EnsembleMap& map, const std::vector<double>& values);
RasterStyle style_of(const EnsembleMap& map, const std::vector<double>& values, const HazardOptions& hazard);

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

/// Mean of the first n members that have a value, and its standard error s / sqrt(n), for growing n.
struct Convergence {
  std::vector<std::int64_t> members;
  std::vector<double> mean, error;  ///< the error is NaN of one member
};

/// Of values in the order of the members, NaN left out; at most `points` steps, evenly spread, the last with all.
Convergence convergence(const std::vector<double>& values, std::size_t points);

/// The refusals that the recipe overrides, in the stages before and in this one: of members the first of each name.
std::vector<Finding> insisted_on(const Ensemble& ensemble);

/// Title, scene, design, seed and numbers of members: name (in capitals) and words.
Facts ensemble_facts(const Ensemble& ensemble);

/// What a map says of itself besides: threshold, unit, meaning of its share and of its error.
Facts map_facts(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard);

/// The tags of a raster: its title with the unit ([-] where it has none), and facts.
RasterTags raster_tags(const std::string& title, const std::string& unit, Facts facts);

/// The tags of a map; `no_data`: what a cell without a value means.
RasterTags map_tags(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard, const char* no_data);

}  // namespace talus::postprocess
