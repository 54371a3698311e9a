// What [preprocess] of a recipe holds. Every key is named once, in describe().
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/domain/bed_numbers.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// Which way a thickness is measured.
enum class Direction { vertical, slope_normal };

/// From which difference on a change is believed (the vocabulary of GCD, Wheaton et al. 2010).
enum class Threshold { minimum_level, propagated_error, probabilistic };

/// What becomes of cells without elevation.
enum class EdgeNodata { refuse, outside };

/// What the heights of elevation models are in: what the files say, or this. `same`: of one model, as of all the
/// others.
enum class VerticalUnit { declared, metre, foot, us_survey_foot, same };

/// One [[preprocess.release]]: a raster of thickness, or polygons with a thickness.
struct ReleaseOptions {
  std::string name;
  std::filesystem::path thickness_raster;
  std::filesystem::path polygons;
  std::string attribute = "thickness";
  double thickness = 0;  // one thickness for all polygons [m]; 0 = that of the attribute
  Direction direction = Direction::vertical;

  void describe(recipe::Visitor& v);
};

/// One [[preprocess.erodible]]: a layer of ground, given as a release is, or all that was lowered outside the source.
struct ErodibleOptions : ReleaseOptions {
  bool lowering = false;

  void describe(recipe::Visitor& v);
};

/// What the numbers of depth points are.
enum class PointValue { elevation, depth };

/// How deep the sliding surface lies that is computed under source.polygon. None given: by the area of the polygon.
struct SlidingSurfaceOptions {
  double depth = 0;   // largest vertical one [m]; 0 = not given
  double volume = 0;  // [m3]; 0 = not given
  std::filesystem::path depth_points;
  PointValue depth_points_hold = PointValue::elevation;
  double depth_points_error = 0;  // standard error [m]

  int ways_given() const { return (depth > 0) + (volume > 0) + !depth_points.empty(); }
  void describe(recipe::Visitor& v);
};

struct SourceOptions {
  std::filesystem::path polygon;
  double threshold = 0.5;                // [m]
  std::optional<double> seed_x, seed_y;  // easting, northing [m]
  SlidingSurfaceOptions sliding_surface;

  void describe(recipe::Visitor& v);
};

/// What is done about surveys that do not lie on one another.
enum class Alignment { check, apply, off };

struct CoregistrationOptions {
  Alignment mode = Alignment::check;
  bool tilt = true;
  double steepest = 45;  // [deg]
  std::filesystem::path changed;

  void describe(recipe::Visitor& v);
};

struct DifferenceOptions {
  Threshold threshold = Threshold::probabilistic;
  double confidence = 0.95;
  double minimum_level = 0;                  // [m]
  double before_sigma = 0, after_sigma = 0;  // [m]; 0 = learnt from stable ground

  /// sqrt(s1^2 + s2^2) [m]; 0 where neither is given.
  double given_sigma() const;
  void describe(recipe::Visitor& v);
};

/// What arrived, for after_dem.
struct DepositOptions {
  std::filesystem::path polygon;
  double threshold = 0.5;  // [m]

  void describe(recipe::Visitor& v);
};

struct GridOptions {
  double spacing = 0;       // [m]; 0 = the cell of the first DEM
  double layer_height = 0;  // [m]; 0 = spacing
  std::vector<int> points_per_cell{2, 2, 2};
  double minimum_thickness = 0;  // [m]
  double jitter = 0;
  int jitter_seed = 1;
  std::optional<double> west, south, east, north;  // [m]
  EdgeNodata edge_nodata = EdgeNodata::refuse;

  void describe(recipe::Visitor& v);
};

/// What is done about cells that stand out from their neighbours.
enum class Spikes { ignore, report, remove };

/// Holes in the elevation models, and cells that stand out of them.
struct VoidOptions {
  bool fill = false;
  double largest = 1e5;  // area [m2]
  Spikes spikes = Spikes::report;

  void describe(recipe::Visitor& v);
};

/// A scene without elevation models: a level or tilted plane, its cells as wide as grid.spacing_m.
struct LaboratoryOptions {
  int columns = 0, rows = 0;   // 0 = no laboratory
  double west = 0, south = 0;  // [m]
  double ground = 0;           // elevation of the south-western corner [m]
  double slope_x = 0, slope_y = 0;

  bool given() const { return columns > 0 || rows > 0; }
  void describe(recipe::Visitor& v);
};

/// Rasters of the bed's friction, under the names of the numbers in [solve.base] that they take the place of.
struct BedRasters {
  std::vector<std::pair<std::string, std::filesystem::path>> files;

  BedRasters() {
    for (const std::string_view key : bed_numbers) files.emplace_back(key, std::filesystem::path());
  }
  void describe(recipe::Visitor& v);
};

/// One [[preprocess.box]]: a block of material; heights count from the ground.
struct BoxOptions {
  std::string name;
  double west = 0, east = 0, south = 0, north = 0, bottom = 0, top = 0;  // [m]

  void describe(recipe::Visitor& v);
};

/// One [[preprocess.obstacle]]: an upright body over polygons, for [[solve.obstacle]] of the same name.
struct ObstacleOptions {
  std::string name;
  std::filesystem::path polygons;
  std::string attribute = "height";
  double height = 0;  // one height for all polygons [m]; 0 = that of the attribute
  double voxel = 0;   // [m]; 0 = a quarter of the smaller spacing

  void describe(recipe::Visitor& v);
};

/// The five ways of saying what fails.
enum class Way { before_and_after, before_and_sliding_surface, before_and_outline, base_and_releases, laboratory };

struct Options {
  std::filesystem::path before_dem, after_dem, sliding_surface, base_dem;
  std::string working_crs;
  VerticalUnit vertical_unit = VerticalUnit::declared;  // never `same`
  VerticalUnit before_vertical_unit = VerticalUnit::same, after_vertical_unit = VerticalUnit::same;
  CoregistrationOptions coregistration;
  DifferenceOptions difference;
  SourceOptions source;
  DepositOptions deposit;
  GridOptions grid;
  VoidOptions voids;
  std::vector<ReleaseOptions> release;
  std::vector<ErodibleOptions> erodible;
  LaboratoryOptions laboratory;
  std::vector<BoxOptions> box;
  BedRasters bed;
  std::vector<ObstacleOptions> obstacle;

  void describe(recipe::Visitor& v);
  /// What the ranges of single keys cannot say: which keys go together.
  void check(std::vector<Fault>& faults) const;
  Way way() const;  ///< only after check() found nothing
  /// The DEM that gives the working grid its CRS, registration and cell.
  const std::filesystem::path& first_dem() const { return base_dem.empty() ? before_dem : base_dem; }
};

}  // namespace talus::preprocess
