// The one main() of the three programs: command line, log, exit codes, files written aside, Ctrl-C, progress line.
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

enum class On { automatic, cpu, gpu };

/// What the command line asked for, and what the stage made.
struct StageContext {
  recipe::Recipe recipe;
  std::filesystem::path out;  ///< exists and is writable unless check_only
  On on = On::automatic;
  bool check_only = false;                       ///< --check: read and test everything cheap, compute and write nothing
  std::optional<std::filesystem::path> restart;  ///< talus-solve --restart [FILE]; empty path = OUT/checkpoint.h5
  bool profile = false;                          ///< talus-solve --profile
  bool plan = false;        ///< talus-solve --plan: say what would run, and what it would cost; write nothing
  bool difference = false;  ///< talus-preprocess --difference: compare the surveys and stop
  std::string command_line;
  std::vector<std::filesystem::path> results;  ///< printed on stdout, one a line, at the end
};

struct Stage {
  std::string name;                            ///< "talus-solve"
  std::string table;                           ///< its recipe table: "solve"
  std::string summary;                         ///< one line
  std::string examples;                        ///< shown under --help
  bool has_on = false;                         ///< takes --on auto|cpu|gpu
  bool has_restart = false;                    ///< takes --restart
  bool has_profile = false;                    ///< takes --profile and --plan
  bool has_difference = false;                 ///< takes --difference
  std::function<std::string()> template_toml;  ///< for --template
  std::function<void(StageContext&)> run;
};

/// Parses the command line, runs the stage, prints faults on stderr and result paths on stdout. Returns the exit code.
/// Options: recipe.toml, --out DIR (default: the recipe's folder / "out"), --check, --template, --on, --restart,
/// --profile, --plan, --difference, -v, -q,
/// --help (exit codes and examples included), --version (with the commit).
int run_stage(int argc, char** argv, const Stage& stage);

/// True once SIGINT or SIGTERM has come. A second one ends the process at once.
bool interrupted();

/// Version of the project, with the commit: "0.1.0 (1a2b3c4)".
std::string version();

/// A file written aside (".NAME.partial" beside it), synced and renamed by commit(); removed if never committed.
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path final_path);
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;
  ~PendingFile();
  const std::filesystem::path& path() const { return partial_; }  ///< write here
  const std::filesystem::path& final_path() const { return final_; }
  void commit();  ///< throws DataError when the file cannot be synced or renamed (disk full)

 private:
  std::filesystem::path final_, partial_;
  bool committed_ = false;
};

/// Write a text file whole, aside and renamed. Throws DataError with the path and the system's reason.
void write_text(const std::filesystem::path& path, const std::string& text);

/// SHA-256 of a file, in hex. Throws DataError.
std::string sha256(const std::filesystem::path& path);
std::string sha256_of_text(const std::string& text);

/// The text of `<stage>.used.toml`: the options with defaults filled in (recipe::to_used_toml marks those that were
/// changed), and above them as comments version, command, inputs with their checksums, CRS, hardware, wall time (pairs
/// of `facts`).
std::string used_recipe(const StageContext& context, const Stage& stage, const std::string& options_toml,
                        const std::vector<std::filesystem::path>& inputs,
                        const std::vector<std::pair<std::string, std::string>>& facts);

/// Writes that text to `OUT/<stage>.used.toml`.
void write_used_recipe(StageContext& context, const Stage& stage, const std::string& options_toml,
                       const std::vector<std::filesystem::path>& inputs,
                       const std::vector<std::pair<std::string, std::string>>& facts);

/// Name of the processor and count of hardware threads: "AMD EPYC 7B13, 2 threads".
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

/// Log lines on stderr (spdlog underneath): facts people read, warnings, and details under -v.
void log_info(const std::string& text);
void log_warning(const std::string& text);
void log_detail(const std::string& text);

}  // namespace talus
