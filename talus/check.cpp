// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/commands.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace talus::command {
namespace fs = std::filesystem;
namespace {

/// What the stages said, sorted into what ends a run and what does not.
class Listing {
 public:
  void add(const std::string& stage, const Said& said) {
    code_ = std::max(code_, static_cast<int>(said.outcome.code));
    for (const Fault& fault : said.outcome.faults) put(faults_, stage, to_string(fault));
    for (const auto& [level, text] : said.lines) put(level == LogLevel::warning ? warnings_ : advice_, stage, text);
  }
  void add_fault(const std::string& stage, const std::string& fault, ExitCode code) {
    code_ = std::max(code_, static_cast<int>(code));
    put(faults_, stage, fault);
  }
  void note(const std::string& text) { notes_.push_back(text); }

  int print(const std::string& scene) const {
    for (const std::string& text : notes_) log_info(text);
    for (const auto& [stage, text] : warnings_) log_warning(fmt::format("{}: {}", stage, text));
    for (const auto& [stage, text] : advice_) log_advice(fmt::format("{}: {}", stage, text));
    for (const auto& [stage, text] : faults_) log_error(fmt::format("{}: {}", stage, text));
    log_info(fmt::format("{}: {}, {}", scene, counted(faults_.size(), "fault"), counted(warnings_.size(), "warning")));
    return code_;
  }

 private:
  using Lines = std::vector<std::pair<std::string, std::string>>;
  static std::string counted(std::size_t count, const std::string& what) {
    return fmt::format("{} {}{}", count == 0 ? "no" : std::to_string(count), what, count == 1 ? "" : "s");
  }
  /// A fault of [scene] is found by every stage.
  static void put(Lines& lines, const std::string& stage, const std::string& text) {
    const auto known = [&](const auto& line) { return line.second == text; };
    if (std::none_of(lines.begin(), lines.end(), known)) lines.emplace_back(stage, text);
  }

  Lines faults_, warnings_, advice_;
  std::vector<std::string> notes_;
  int code_ = 0;
};

/// Inputs of the scores that no stage makes and that are not there.
void look_for_files(const Request& request, Listing& listing) {
  for (const fs::path& input : depends_of(request, "postprocess").inputs)
    if (!lies_in(input, request.out) && !fs::exists(input))
      listing.add_fault("postprocess",
                        input.string() + ": no such file. A recipe names it: put it there, or mend the recipe",
                        ExitCode::data);
}

bool up_to_date(const Request& request, const std::string& stage) {
  const Stage program = stage_called(stage);
  return judge_freshness(program, open_call(program, call_of(request, stage))).run_because.empty();
}

Said check_stage(const Request& request, const std::string& stage) {
  StageCall call = call_of(request, stage);
  call.check_only = true;
  return call_quietly(stage, call);
}

/// Data and physics of a recipe whose tables are in order.
void check_together(const Request& request, Listing& listing) {
  Request at_work = request;
  std::optional<TemporaryFolder> folder;
  const bool has_domain = up_to_date(request, "preprocess");
  if (has_domain) {
    listing.add("preprocess", check_stage(request, "preprocess"));
  } else if (recipe::Recipe(request.recipe, request.set).canonical("preprocess")) {
    folder.emplace("talus-check");
    at_work.out = at_work.shown = folder->path();
    const Said said = call_quietly("preprocess", call_of(at_work, "preprocess"));
    listing.add("preprocess", said);
    if (said.outcome.code != ExitCode::success) {
      look_for_files(request, listing);
      return listing.note("solve: its physics can be checked once the domain can be prepared");
    }
  }
  stop_if_interrupted("checking the recipe");
  listing.add("solve", check_stage(at_work, "solve"));
  stop_if_interrupted("checking the recipe");
  if (has_domain && up_to_date(request, "solve"))
    listing.add("postprocess", check_stage(request, "postprocess"));
  else
    look_for_files(request, listing);
}

}  // namespace

int check_scene(const Request& request) {
  Listing listing;
  bool readable = true;
  for (const char* stage : stage_names) {
    std::vector<Fault> faults;
    add_table_faults(request, stage, faults);
    for (const Fault& fault : faults) listing.add_fault(stage, to_string(fault), ExitCode::recipe);
    readable = readable && faults.empty();
  }
  if (readable) check_together(request, listing);
  return listing.print(request.recipe.filename().string());
}

}  // namespace talus::command
