// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The results of an ensemble, of an error budget, of many slides: their maps, files and pages. Values of slides are
// kept where these came, and nowhere else: the elevation model may be larger than memory.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/qgis/style.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/ensemble/budget_table.hpp"
#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/ensemble/member_analysis.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/report/report.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

struct EnsemblePageInput {
  const Ensemble& ensemble;
  const Options& options;
  const std::optional<Survey>& survey;
  const MemberRows& rows;
  const std::vector<std::pair<std::string, Sensitivity>>& sensitivity;
  std::vector<StageText> stages;
  const BudgetTable* budget = nullptr;  ///< of a budget; null: it is none
  std::vector<double> residual = {};    ///< in sigma, of draws of a calibration (residual.hpp); else empty
  Json calibration = {};                ///< calibration.json of the draws, without runs; else null
};

/// What a page holds at most; it stays below some ten megabytes and says what it leaves out.
inline constexpr std::size_t members_on_page = 2000;     ///< in scatter, parallel coordinates and table
inline constexpr std::size_t outline_numbers = 600'000;  ///< coordinates of all outlines
inline constexpr std::size_t cells_on_page = 4'000'000;  ///< of all maps together
inline constexpr std::size_t cells_of_one_map = 300'000;

/// What the page has of maps and outlines, and members that stand for others.
struct PageParts {
  Json map, outlines, medoids;
};

/// No member stands for others.
Json no_medoids();

/// The page as HTML that loads nothing from elsewhere. Throws DataError where a *.used.toml cannot be read.
std::string ensemble_html(const EnsemblePageInput& input);

/// A map as the page shows it, drawn in the classes of its style for QGIS.
struct MapOnPage {
  std::string id, title, unit;
  double level = nan;  ///< threshold or share; NaN: it has none
  RasterStyle style;
  Raster raster;
};

/// A map of an ensemble with its style and what is shown of it.
MapOnPage map_on_page(const EnsembleMap& map, RasterStyle style, Raster raster);

/// So many maps of one grid, packed end to end.
Json packed_maps(std::size_t count, const std::function<MapOnPage(std::size_t)>& made);

/// Ground, of every quantity shares, quantiles, mean and deviation, and hazard classes; of a budget the maps of spread.
Json ensemble_maps_json(const EnsemblePageInput& input, const Window& window);

/// A quantity with its packed maps, shares null where there are none.
Json quantity_json(const CountedMap& what, Json shares, Json statistics);

/// Outlines of flow and deposit of the first members, as lists of whole numbers x, y, x, y ... of half cells from the
/// corner of `shown`, the cells of the window, corners alone; and of release and survey [m from the window's corner].
Json ensemble_outlines_json(const EnsemblePageInput& input, const Window& window, const MapGrid& shown);

/// One closed outline after another around the cells of a footprint, in half cells from the grid's corner.
std::vector<std::vector<int>> footprint_outlines(const std::vector<std::uint8_t>& cells, const MapGrid& grid);

/// Reads members.h5 and the counts in OUT and writes what follows from them, of an ensemble probability.nc last, of a
/// budget budget.json, of slides slides.nc. With context.check_only it reads and tests alone. `alone`: there is no
/// run.h5 besides, whose results would say what is doubtful in the survey. `members_only`: nothing beyond members.csv
/// and likelihood.json. Throws DataError.
void run_ensemble(StageContext& context, const Stage& stage, Options options, bool alone, bool members_only);

/// What run_ensemble() reads, and its last result.
Dependencies ensemble_depends(const StageContext& context);

/// Writes FOLDER/NAME.tif (cloud-optimised) and NAME.qml of every map, the ground with its hillshade, outlines.gpkg (of
/// probabilities at 5, 50 and 95 %, and of the release) and SCENE.qgs. Returns the files. Throws DataError.
/// `residual`: the map of that name; empty: none.
std::vector<std::filesystem::path> write_probability_maps(const std::filesystem::path& folder, const Ensemble& ensemble,
                                                          const Options& options, const std::vector<double>& residual);

/// How a map of spread is drawn.
RasterStyle spread_style(const SpreadMap& map);
/// Of residuals in standard deviations: blue where the draws are thicker than the survey.
RasterStyle residual_style();

/// Writes the maps of spread of a budget, each with its style, the ground with its hillshade, outlines.gpkg (of the
/// release) and SCENE-budget.qgs. Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_spread_maps(const std::filesystem::path& folder, const Ensemble& ensemble,
                                                     const Options& options, const BudgetTable& table);

/// Writes slides.nc: CF-1.8, the table of slides as a group. Throws DataError.
void write_slides_netcdf(const std::filesystem::path& file, const Ensemble& ensemble, const MemberRows& rows,
                         const Options& options, const std::string& command_line);

/// Writes probability.nc: CF-1.8, thresholds and quantiles as coordinates, members as a group. Throws DataError.
void write_probability_netcdf(const std::filesystem::path& file, const Ensemble& ensemble, const MemberRows& rows,
                              const Options& options, const std::string& command_line);

/// All of them: of every quantity the largest value, then for each threshold number and share of the slides.
std::vector<EnsembleMap> slide_maps(const Ensemble& ensemble);

/// The values of a map by place of the counts; NaN where no slide came (or none passes the threshold).
std::vector<double> slide_values(const Ensemble& ensemble, const EnsembleMap& map);

/// The part of the lattice in which slides came, and some cells around.
CellWindow reached_cells(const Ensemble& ensemble);

/// A map over a part of the lattice, blocks of `factor` x `factor` cells made one: their largest value, of a time the
/// smallest; NaN where there is none.
Raster coarse_map(const Ensemble& ensemble, const EnsembleMap& map, const std::vector<double>& values,
                  const CellWindow& part, int factor);

struct SparseValues {
  MapGrid grid;
  KeptCells cells;
  std::vector<double> values;  ///< by place; NaN: none
};

/// A map on cells twice as wide, counted from the north-west corner: the largest of four, of a time the smallest.
SparseValues halved(const SparseValues& values, const MapGrid& grid, bool smallest);

/// Writes into `folder` every map as a GeoTIFF that holds only tiles with values, with its style; ground.tif;
/// slides.gpkg (release, flow and deposit of each slide, with its row of the table); SCENE-slides.qgs. Returns the
/// files. Throws DataError.
std::vector<std::filesystem::path> write_slide_files(const std::filesystem::path& folder, const Ensemble& ensemble,
                                                     const MemberRows& rows);

/// What the page of many slides has of maps and outlines.
PageParts slide_page_parts(const EnsemblePageInput& input);

}  // namespace talus::postprocess
