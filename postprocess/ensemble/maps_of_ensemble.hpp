// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of an ensemble: one list for GeoTIFF, NetCDF, QGIS and the page.
#pragma once

#include <string>
#include <vector>

#include "common/qgis/style.hpp"
#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// What a map of an ensemble says.
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

}  // namespace talus::postprocess
