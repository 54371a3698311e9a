// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// ensemble.html: one self-contained page about an ensemble, for people.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "postprocess/ensemble/budget_table.hpp"
#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/ensemble/member_rows.hpp"
#include "postprocess/ensemble/sensitivity.hpp"
#include "postprocess/fields/window.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/report/report.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// What the page is made from.
struct EnsemblePageInput {
  const Ensemble& ensemble;
  const Options& options;
  const std::optional<Survey>& survey;
  const MemberRows& rows;
  const std::vector<std::pair<std::string, Sensitivity>>& sensitivity;
  std::vector<StageText> stages;
  const BudgetTable* budget = nullptr;  ///< of a budget; null: it is none
};

/// What a page holds at most; it stays below some ten megabytes and says what it leaves out.
inline constexpr std::size_t members_on_page = 2000;     ///< in scatter, parallel coordinates and table
inline constexpr std::size_t outline_numbers = 600'000;  ///< coordinates of all outlines
inline constexpr std::size_t cells_on_page = 4'000'000;  ///< of all maps together
inline constexpr std::size_t cells_of_one_map = 300'000;

using Json = nlohmann::ordered_json;

/// What the page has of maps and outlines, and members that stand for others.
struct PageParts {
  Json map, outlines, medoids;
};

/// No member stands for others.
Json no_medoids();

/// The page as the bytes of an HTML file: nothing in it is loaded from elsewhere. Throws DataError where a *.used.toml
/// cannot be read.
std::string ensemble_html(const EnsemblePageInput& input);
std::string ensemble_html(const EnsemblePageInput& input, PageParts parts);

/// A map as the page shows it, drawn in the classes of its style for QGIS.
struct MapOnPage {
  std::string id, title, unit;
  double level = nan;  ///< threshold or share; NaN: it has none
  RasterStyle style;
  Raster raster;
};

/// So many maps of one grid, packed end to end.
Json packed_maps(std::size_t count, const std::function<MapOnPage(std::size_t)>& made);

/// The part of the map that is shown: all that any member reached, released or surveyed.
Window ensemble_window(const EnsemblePageInput& input);

/// Ground, and of every quantity the shares at its thresholds, its quantiles, mean and deviation; hazard classes. Of a
/// budget the maps of spread.
/// `coarsest` is left as the largest number of cells made one along a side.
Json ensemble_maps_json(const EnsemblePageInput& input, const Window& window, int& coarsest);

/// A quantity with its packed maps, shares null where there are none.
Json quantity_json(const CountedMap& what, Json shares, Json statistics);

/// Outlines of flow and deposit of the first members, as lists of whole numbers x, y, x, y ... of half cells from the
/// corner of `shown`, the cells of the window, corners alone; and of release and survey [m from the window's corner].
Json ensemble_outlines_json(const EnsemblePageInput& input, const Window& window, const MapGrid& shown);

/// One closed outline after another around the cells of a footprint, in half cells from the grid's corner.
std::vector<std::vector<int>> footprint_outlines(const std::vector<std::uint8_t>& cells, const MapGrid& grid);

}  // namespace talus::postprocess
