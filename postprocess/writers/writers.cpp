// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fnmatch.h>

#include <algorithm>
#include <ranges>
#include <system_error>

#include "common/stage/in_threads.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

void remove_matching(const fs::path& out, const std::string& pattern) {
  const fs::path folder = (out / pattern).parent_path();
  std::error_code none_there;
  Files old;
  for (const auto& entry : fs::directory_iterator(folder, none_there))
    if (entry.is_regular_file() && matches({pattern}, fs::relative(entry.path(), out, none_there).generic_string()))
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

Writers::Writers() : all_(all_writers()) {}

std::vector<std::string_view> Writers::words() const {
  std::vector<std::string_view> all;
  for (const auto& writer : all_)
    for (const std::string_view word : writer->words()) all.push_back(word);
  return all;
}

void Writers::check(const Job& job) const {
  for (const auto& writer : all_)
    if (writer->wanted(job)) writer->check(job);
}

void Writers::remove_outdated(const fs::path& out) const {
  for (const auto& writer : std::views::reverse(all_))
    for (const std::string& pattern : writer->outdated()) remove_matching(out, pattern);
}

Files Writers::write(const Job& job) const {
  std::vector<Files> written(all_.size());
  const auto write_one = [&](std::size_t i) {
    if (!all_[i]->wanted(job)) return;
    stop_if_interrupted("writing " + all_[i]->name());
    written[i] = all_[i]->write(job);
  };
  const std::size_t last = all_.size() - 1;
  in_threads(2, "writing results", [&](std::size_t lane) {
    for (std::size_t i = 0; i < last; ++i)
      if (all_[i]->stands_alone() == (lane == 1)) write_one(i);
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
