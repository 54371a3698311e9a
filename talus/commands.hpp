// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of talus beside the stages.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"
#include "common/stage/context.hpp"
#include "common/stage/stage.hpp"

namespace talus::command {

/// A folder that goes again with all it holds.
class TemporaryFolder {
 public:
  /// Makes a folder of a name that nobody has, in TMPDIR. Throws DataError.
  explicit TemporaryFolder(const std::string& name);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The stages in the order in which they run.
inline constexpr std::array<const char*, 3> stage_names{"preprocess", "solve", "postprocess"};

struct Request {
  std::filesystem::path recipe;
  std::filesystem::path out = {};     ///< absolute
  std::filesystem::path shown = {};   ///< the same as the user gave it, for the log and the results; empty: not given
  std::vector<std::string> set = {};  ///< overrides of the recipe
  std::string on = "auto";            ///< where talus-solve runs
  int threads = 0;                    ///< to use at most; 0: as many as a process may run at once
  bool network = false;
  bool verbose = false, quiet = false;
  bool plan = false;  ///< print the plan of the solver instead of running it
};

/// The stage of a name in stage_names. Each call makes a stage with flags of its own.
Stage stage_called(const std::string& name);

/// The call of a stage that a request asks for; talus-solve gets --on.
StageCall call_of(const Request& request, const std::string& stage);

/// What a stage reads and writes. Throws RecipeError.
Dependencies depends_of(const Request& request, const std::string& stage);

/// What a stage has logged, and its end.
struct Said {
  StageOutcome outcome;
  std::vector<std::pair<LogLevel, std::string>> lines = {};  ///< advice and warnings
};

/// Thrown where a stage of one of several runs fails.
struct StageFailed {
  StageOutcome outcome;
};

/// Calls a stage; its log is kept instead of written.
Said call_quietly(const std::string& stage, const StageCall& call);

/// The faults that a stage finds in its tables, those of `known` left out.
void add_table_faults(const Request& request, const std::string& stage, std::vector<Fault>& known);

/// Of the files that the runs of a request read besides their own results; numbers of keys change none of them.
std::string inputs_mark(const Request& request);

/// Of version, inputs (inputs_mark) and tables: runs of the same mark have the same results.
std::string run_mark(const Request& request, const std::string& inputs);

/// Throws RecipeError with the faults that all stages find in their tables.
void require_tables(const Request& request);

/// Whether a file lies below a folder.
bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Checks the tables of all stages, then, as far as they go together, the data and the physics: the domain is prepared
/// in a folder of its own that goes again, unless the one in the results is up to date. Prints the faults and warnings
/// on stderr; writes nothing into the results. Returns 0, or the largest exit code of a stage.
int check_scene(const Request& request);

/// Compares the runs in two folders of results: talus-postprocess --against writes FIRST/comparison.html. Returns its
/// exit code. Throws DataError where one of the folders holds no run.
int compare_runs(const std::filesystem::path& first, const std::filesystem::path& second, const Request& request);

/// Two elevation models, or one and the outline of what may fail.
struct NewScene {
  std::filesystem::path before, after;  ///< `after`: the second model, or the outline (a vector file)
  std::filesystem::path recipe;         ///< to be written
  bool overwrite = false;
  std::vector<double> at = {};         ///< [easting, northing] in the slide; empty: it is found
  std::filesystem::path outline = {};  ///< of the slide's source; empty: it is found
  std::filesystem::path ignore = {};   ///< polygons whose change is not looked at
  // How much is released within an outline; none: by its area.
  std::optional<double> thickness = {};  ///< everywhere, vertical [m]
  std::filesystem::path prior = {};      ///< of the friction, as [ensemble] takes it
  std::optional<double> volume = {};     ///< above a curved sliding surface [m3]
  std::optional<double> depth = {};      ///< of a curved sliding surface, at most [m]
};

/// Compares two models, or lays a release under the outline, proposes spacing, layers, friction and end time from what
/// fails, and writes the recipe; of an outline with the doubts that maps of probability need. It asks nothing. Returns
/// 0. Throws DataError where the two models show no slide, or several that it might be, with what talus-preprocess says
/// of them, and where the recipe is there already; RecipeError: two amounts, or one beside two models.
int new_scene(const NewScene& scene);

/// Runs the stages that have to; prints the results of all on stdout. With request.plan it runs talus-preprocess alone
/// and prints the plan of the solver. Returns the exit code of the stage that failed, or 0.
int run_scene(const Request& request);

/// Brings the stages up to date as run_scene() does, but prints nothing and keeps their log, up to the stage that
/// fails.
Said run_quietly(const Request& request);

/// Changes the keys of [fit] from run to run (search()) until the run agrees with the survey, and prints a line each;
/// OUT/fit.json keeps the runs, which a second call does not repeat. Writes the recipe of the best one beside the
/// recipe, fitted.toml, and runs it. Returns the exit code of a stage that failed, or 0. Throws RecipeError: no key, or
/// one that has no effect; DataError: no survey, a fitted.toml that a person wrote.
int fit_scene(const Request& request);

/// Draws the keys of [[ensemble.vary]] from their distributions as the survey makes them probable (draw_posterior()),
/// on the scene itself: OUT/calibration.json keeps the runs, which a second call does not repeat. Writes posterior.csv
/// (the draws), fitted.toml beside the recipe (the most probable one), and the results of the ensemble of all draws.
/// Returns the exit code of a stage that failed, or 0. Throws RecipeError: nothing varies, too few members, members of
/// another kind; DataError: no survey, no run with a likelihood, a fitted.toml that a person wrote.
int calibrate_scene(const Request& request);

struct DataRequest {
  std::string name;             ///< of an example; empty: list them
  std::filesystem::path out;    ///< the folder DATA, in which that of the example is made
  std::filesystem::path from;   ///< a folder that holds the sources, or the files made of them; empty: they are fetched
  bool exact = false;           ///< refuse what differs in its bytes alone, and what no checksum is known of
  std::filesystem::path table;  ///< a table of examples of one's own; empty: the one of this program
};

/// The table of examples that is part of this program (talus/public_data.toml).
std::string_view public_data_table();

/// Lists the examples with licence, repository, commit and address, or makes one of them: fetches its sources with the
/// program curl, or takes them from a folder, makes its files, compares each with what it must hold (files that were
/// there already with their SHA-256 too), and writes SOURCE.md beside them. Returns 0. Throws RecipeError, DataError.
int make_data(const DataRequest& request);

/// What went down and what rose between the two models.
struct Slide {
  double cell = 0;              ///< of the elevation models [m]
  double volume = 0;            ///< of the release [m3]
  double area = 0;              ///< of the release in plan [m2]
  double width = 0;             ///< of the release: four times its area over its outline [m]
  double median_thickness = 0;  ///< half of the volume stands in thicker columns [m]
  double crown = 0;             ///< elevation of the highest released cell [m]
  double drop = 0;              ///< from the crown to the deposit cell farthest from it [m]; 0: no deposit is known
  double length = 0;            ///< between the two in plan [m]
  double travel_tangent = 0;    ///< drop over distance of the centre of mass [-]; 0: no deposit is known
  double head = 0;              ///< largest height of the energy line from crown to deposit above the ground [m]

  bool has_deposit() const { return length > 0; }
};

/// Measures a slide. `before` is the surface before it, `release` the vertical thickness of what fails, `deposit` that
/// of what rose (empty: not known), all on one grid [m].
Slide measure_slide(const Raster& before, const Raster& release, const std::optional<Raster>& deposit);

/// The tangent of the Fahrboeschung, height over length of fall, that is usual for a volume [m3]: Scheidegger (1973)
/// for 1e5 m3 and more, Corominas (1996), all of his landslides, for less [-].
double usual_reach_tangent(double volume);

/// What a first recipe proposes.
struct Proposal {
  double spacing = 0;         ///< of the cells [m]
  double layer_height = 0;    ///< [m]
  double layers = 0;          ///< over the median thickness
  double cells_across = 0;    ///< over the width of the release
  double bed_angle = 0;       ///< [deg]
  double internal_angle = 0;  ///< [deg]
  double end_time = 0;        ///< [s]
  double points = 0;          ///< material points, eight in a cell
};

/// Spacing: twenty cells across the release, but not finer than the models, unless eight need it. Layers: four and a
/// half or more over the median thickness, none higher than a cell is wide. Bed: 0.85 times the tangent at which the
/// centre of mass went, or the usual Fahrboeschung. Inside: 1.4 times its tangent (material-laws.md). End: four times
/// the way over the largest speed that the energy line allows, twice what a block takes that speeds up and slows down
/// evenly.
Proposal propose(const Slide& slide);

}  // namespace talus::command
