// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Stages as values, and what runs them: from a command line or from another program. Files written aside, Ctrl-C, log.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/recipe/recipe.hpp"

namespace talus {

struct Dependencies {
  std::vector<std::filesystem::path> results;      ///< files that the stage writes; the last one written stands first
  std::vector<std::filesystem::path> inputs;       ///< files that it reads besides the recipe
  std::vector<std::filesystem::path> sealed = {};  ///< of these, sealed ones: it notes the checksum of what it reads
};

struct Stage;
struct StageContext;

/// What the results of a stage are made of.
struct Ingredients {
  /// Tables of the recipe, defaults filled in, each with the SHA-256 of its text.
  std::vector<std::pair<std::string, std::string>> tables = {};
  /// Files with their SHA-256: empty where one is no plain file, none where the stage notes it as it reads the file.
  std::vector<std::pair<std::filesystem::path, std::optional<std::string>>> inputs = {};
};

/// The ingredients of a call as they are now. Throws what the stage throws where the recipe or an input is wrong.
Ingredients ingredients_of(const Stage& stage, const StageContext& context);

/// Completes the used recipe of a stage that has written all results: adds their names and ids.
void note_results(const Stage& stage, const StageContext& context);

struct Verdict {
  std::string run_because = {};                     ///< why the stage runs; empty: the results are up to date
  std::string remark = {};                          ///< a warning where they are
  std::vector<std::filesystem::path> results = {};  ///< all that the stage has written, where they are up to date
};

/// The rule of freshness. Results are up to date where the used recipe names the same version and the same tables,
/// where each input has the checksum noted, and where each result is there with the id noted. A missing input counts as
/// unchanged; the remark names it.
Verdict judge_freshness(const Stage& stage, const StageContext& context);

/// What the command line asked for, and what the stage made.
struct StageContext {
  recipe::Recipe recipe;
  std::filesystem::path out;  ///< exists and is writable unless check_only
  bool check_only = false;    ///< --check: read and test everything cheap, compute and write nothing
  std::string command_line;
  std::string part = {};  ///< of the stage's work that this process does ("0-250"); empty: all of it
  std::vector<std::filesystem::path> results = {};  ///< printed on stdout, one a line, at the end
  Ingredients made_of = {};                         ///< what the used recipe says that the results are made of
};

/// A flag that one stage alone knows. The stage registers it and keeps its value where `set` puts it.
struct Flag {
  std::string name;                       ///< "--restart"
  std::string help;                       ///< one line
  std::string value = {};                 ///< what stands for its value in --help: "FILE", "[FILE]" where
                                          ///< it may be left out; empty where it has none
  std::vector<std::string> choices = {};  ///< the words that it takes; then `value` is made of them
  bool writes_nothing = false;            ///< with it the output folder is not made
  std::function<void(const std::string& value)> set = {};  ///< called where the flag is given
};

struct Stage {
  std::string name;                                             ///< "talus-solve"
  std::string table;                                            ///< its recipe table: "solve"
  std::string summary;                                          ///< one line
  std::string examples;                                         ///< shown under --help
  std::vector<Flag> flags = {};                                 ///< its own flags, in the order of --help
  std::function<std::string()> template_toml;                   ///< for --template
  std::function<std::string(const recipe::Recipe&)> used_toml;  ///< its tables with the defaults filled in
  std::function<Dependencies(const StageContext&)> depends;     ///< the files that it reads and writes
  std::function<std::string(const std::filesystem::path& result)> id_of = {};  ///< the id in a result; empty: none
  std::function<std::string()> part = {};  ///< a word for the part that the flags ask for; parts share a folder
  std::function<void(StageContext&)> run;
};

/// A call of a stage, by its command line or by a program that links it.
struct StageCall {
  std::filesystem::path recipe = {};
  std::filesystem::path out = {};                               ///< as given; empty: "out" beside the recipe
  std::vector<std::string> set = {};                            ///< overrides of the recipe
  std::vector<std::pair<std::string, std::string>> flags = {};  ///< of stage.flags: {"--on", "cpu"}, {"--resume", ""}
  bool check_only = false;
  bool if_outdated = false;  ///< results that are up to date are printed, not made again
  std::string command = {};  ///< for the results; empty: made of the above
};

struct StageOutcome {
  ExitCode code = ExitCode::success;
  std::vector<Fault> faults = {};
  std::vector<std::filesystem::path> results = {};
};

/// The end of the --help of every program.
inline constexpr const char* exit_codes =
    "Exit codes: 0 done, 1 a bug, 2 the recipe or the command line is wrong, 3 a file is wrong or cannot be written,\n"
    "4 the computation failed, 130 ended by Ctrl-C.\n"
    "Result paths go to stdout, everything for people to stderr.";

/// The `main` of a stage's program: parses the command line, runs the stage, prints faults on stderr and result paths
/// on stdout. Returns the exit code. Options of every stage: recipe.toml, --out DIR (default: the recipe's folder /
/// "out"), --set KEY=VALUE, --check, --if-outdated, --template, --threads N, --network, --on (which only a stage that
/// runs kernels heeds), -v, -q, --help (with exit codes), --version (with the commit); and those of stage.flags.
int run_stage(int argc, char** argv, const Stage& stage);

/// Runs a stage in the calling thread's context, its folder locked. Throws nothing, prints nothing but the log.
StageOutcome call_stage(const Stage& stage, const StageCall& call);

/// The recipe and the folder of a call, its flags set; the folder is not made. Throws RecipeError.
StageContext open_call(const Stage& stage, const StageCall& call);

/// What `work` ends with: any exception as an outcome. `work` may return the results.
StageOutcome outcome_of(const std::function<std::vector<std::filesystem::path>()>& work);

/// The faults on stderr, each behind the program's name. Returns the exit code.
int report_faults(const std::string& program, const StageOutcome& outcome);

/// Result paths on stdout, one a line. Throws DataError where stdout takes none.
void print_results(const std::vector<std::filesystem::path>& results);

/// True once SIGINT or SIGTERM has come. A second one ends the process at once.
bool interrupted();

/// Throws Interrupted once a signal has come: "stopped while DOING". For loops of stages that have nothing to save.
void stop_if_interrupted(const std::string& doing);

/// Version of the project, with the commit: "0.1.0 (1a2b3c4)".
std::string version();

/// A file written aside (".NAME.PROCESS.partial" beside it, so that two processes never write into one), synced and
/// renamed by commit(); removed if never committed, also when a signal ends the process. What a killed process left
/// under such a name is removed first, where the output folder is known to be this process's own.
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path final_path);
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile();
  const std::filesystem::path& path() const { return partial_; }  ///< write here
  const std::filesystem::path& final_path() const { return final_; }
  void commit() { commit(final_); }
  /// Throws DataError when it cannot be synced or renamed (disk full), or its folder not synced. `name`: another one,
  /// in the same file system.
  void commit(const std::filesystem::path& name);

 private:
  std::filesystem::path final_, partial_;
  bool committed_ = false;
};

/// Makes a folder and those above it that are missing, and forces their entries to the disk: a power cut after what is
/// written there does not lose the folder. Throws DataError.
void make_folder(const std::filesystem::path& folder);

/// Removes a file, if there is one, and forces its absence to the disk: what it counted on may go. Throws DataError.
void remove_for_good(const std::filesystem::path& file);

/// Write a text file whole, aside and renamed. Throws DataError with the path and the system's reason.
void write_text(const std::filesystem::path& path, const std::string& text);

/// SHA-256 of a file, in hex. Throws DataError.
std::string sha256(const std::filesystem::path& path);
std::string sha256_of_text(const std::string& text);

/// "OUT/solve.used.toml" for ".used.toml", of a part "OUT/solve.0-250.used.toml".
std::filesystem::path file_of(const Stage& stage, const StageContext& context, const std::string& ending);

/// The text of `<stage>.used.toml`: the options with defaults filled in (recipe::to_used_toml marks those that were
/// changed), and above them as comments version, command, context.made_of and further inputs with their checksums, CRS,
/// hardware, wall time (pairs of `facts`).
std::string used_recipe(const StageContext& context, const Stage& stage, const std::string& options_toml,
                        const std::vector<std::filesystem::path>& inputs,
                        const std::vector<std::pair<std::string, std::string>>& facts);

/// Writes that text to `OUT/<stage>.used.toml`.
void write_used_recipe(StageContext& context, const Stage& stage, const std::string& options_toml,
                       const std::vector<std::filesystem::path>& inputs,
                       const std::vector<std::pair<std::string, std::string>>& facts);

/// Name of the processor and the number of threads that this process takes at most: "AMD EPYC 7B13, 2 threads".
std::string hardware();

/// One line redrawn on a terminal; elsewhere one line every ten seconds. Goes to stderr; silent under -q.
class Progress {
 public:
  Progress();
  ~Progress();       ///< ends the line
  bool due() const;  ///< true when an update would be seen: make the text only then
  void update(const std::string& text);

 private:
  bool terminal_, quiet_, drawn_ = false;
  std::chrono::steady_clock::time_point last_;
};

/// Lines of the calling thread's log: facts people read, advice, warnings, and details under -v.
void log_info(const std::string& text);
void log_advice(const std::string& text);
void log_warning(const std::string& text);
void log_detail(const std::string& text);

}  // namespace talus
