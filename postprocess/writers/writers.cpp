// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// All outputs of a run, and what goes over them.
#include <algorithm>
#include <chrono>
#include <ranges>
#include <system_error>

#include <fmt/format.h>
#include <fnmatch.h>

#include "common/stage/inside.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/options/writer.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {

Writer geotiff_writer();    // maps/rasters.cpp
Writer gis_writer();        // maps/gis.cpp
Writer hazard_writer();     // maps/hazard_maps.cpp
Writer avaframe_writer();   // maps/rasters.cpp
Writer netcdf_writer();     // maps/rasters.cpp
Writer vtk_writer();        // three_d/three_d.cpp
Writer picture_writer();    // picture/picture.cpp
Writer animation_writer();  // picture/picture.cpp
Writer history_writer();    // maps/history_files.cpp
Writer buildings_writer();  // maps/hazard_maps.cpp
Writer used_writer();       // writers/writers.cpp
Writer report_writer();     // report/report.cpp
Writer score_writer();      // writers/writers.cpp

/// The scores come last: score.json marks complete results.
std::vector<Writer> all_writers() {
  return {geotiff_writer(), gis_writer(),     hazard_writer(),    avaframe_writer(), netcdf_writer(),
          vtk_writer(),     picture_writer(), animation_writer(), history_writer(),  buildings_writer(),
          used_writer(),    report_writer(),  score_writer()};
}

Writer used_writer() {
  return {.name = "used recipe",
          .names = {"postprocess.used.toml"},
          .write = [](const Job& job) { return Files{write_file(job, "postprocess.used.toml", job.used())}; },
          .outdated = std::vector<std::string>{}};
}

Writer score_writer() {
  return {.name = "scores", .names = {"score.json", "score.txt"}, .write = [](const Job& job) {
            return Files{write_file(job, "score.txt", to_table(job.score)),
                         write_file(job, "score.json", to_json(job.score))};
          }};
}

namespace fs = std::filesystem;
namespace {

void remove_matching(const fs::path& out, const std::string& pattern) {
  require_inside(out / pattern);
  const fs::path folder = (out / pattern).parent_path();
  std::error_code none_there;
  Files old;
  for (const auto& entry : fs::directory_iterator(folder, none_there))
    if (fs::is_regular_file(entry.symlink_status(none_there)) &&
        matches({pattern}, fs::relative(entry.path(), out, none_there).generic_string()))
      old.push_back(entry.path());
  for (const fs::path& file : old) fs::remove(file, none_there);
  if (folder != out) fs::remove(folder, none_there);  // only an empty one
}

}  // namespace

bool matches(const std::vector<std::string>& patterns, const std::string& path) {
  return std::ranges::any_of(patterns, [&](const std::string& pattern) {
    return ::fnmatch(pattern.c_str(), path.c_str(), FNM_PATHNAME) == 0;
  });
}

bool Writer::wanted(const Job& job) const {
  if (asked_for) return asked_for(job);
  return words.empty() ||
         std::ranges::any_of(words, [&](const std::string_view word) { return job.options.writes(word); });
}

std::vector<std::string_view> output_words() {
  std::vector<std::string_view> all;
  for (const Writer& writer : all_writers()) all.insert(all.end(), writer.words.begin(), writer.words.end());
  return all;
}

void check_outputs(const Job& job) {
  for (const Writer& writer : all_writers())
    if (writer.check && writer.wanted(job)) writer.check(job);
}

void remove_outdated_outputs(const fs::path& out) {
  const std::vector<Writer> all = all_writers();
  for (const Writer& writer : std::views::reverse(all))
    for (const std::string& pattern : writer.outdated.value_or(writer.names)) remove_matching(out, pattern);
}

Files write_outputs(const Job& job) {
  const std::vector<Writer> all = all_writers();
  std::vector<Files> written(all.size());
  const auto write_one = [&](std::size_t i) {
    if (!all[i].wanted(job)) return;
    stop_if_interrupted("writing " + all[i].name);
    const auto begun = std::chrono::steady_clock::now();
    written[i] = all[i].write(job);
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - begun;
    log_detail(fmt::format("{}: {:.2f} s", all[i].name, since.count()));
  };
  const std::size_t last = all.size() - 1;
  in_threads(2, "writing results", [&](std::size_t lane) {
    for (std::size_t i = 0; i < last; ++i)
      if (all[i].stands_alone == (lane == 1)) write_one(i);
  });
  write_one(last);
  Files files;
  for (const Files& some : written) files.insert(files.end(), some.begin(), some.end());
  return files;
}

fs::path write_file(const Job& job, const std::string& name, const std::string& bytes) {
  stop_if_interrupted("writing " + name);
  fs::path file = job.out / name;
  write_text(file, bytes);
  return file;
}

fs::path folder_of(const Job& job, const std::string& name) {
  fs::path folder = job.out / name;
  make_folder(folder);
  return folder;
}

}  // namespace talus::postprocess
