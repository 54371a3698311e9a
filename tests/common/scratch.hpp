// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Helpers of the tests: a folder that goes away again, and a fault caught with its exact text.
#pragma once

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "common/error.hpp"

namespace talus::test {

/// A fresh folder, removed with all it holds.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "talus-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder could be made: " + name);
    folder_ = name;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  const std::filesystem::path& folder() const { return folder_; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// A text with `here` where this folder stands in it.
  std::string from_here(std::string text, const std::string& here = "./") const {
    const std::string start = folder_.string() + "/";
    for (std::size_t at; (at = text.find(start)) != std::string::npos;) text.replace(at, start.size(), here);
    return text;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::recursive_directory_iterator(folder_), {}));
  }

 private:
  std::filesystem::path folder_;
};

/// Names of what lies in a folder, sorted.
inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What `call` threw, as the user would read it; "" when it threw nothing. Other exceptions pass through.
template <class Kind, class Call>
std::string fault_of(Call&& call) {
  try {
    call();
  } catch (const Kind& error) {
    return error.what();
  }
  return "";
}

/// What is wrong by each fault that `call` threw.
template <class Kind, class Call>
std::vector<std::string> whats_of(Call&& call) {
  std::vector<std::string> whats;
  try {
    call();
  } catch (const Kind& error) {
    for (const Fault& fault : error.faults()) whats.push_back(fault.what);
  }
  return whats;
}

/// While it lives no file may grow beyond `bytes`: writes fail half-way, as they do on a full disk.
class SmallFiles {
 public:
  explicit SmallFiles(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  SmallFiles(const SmallFiles&) = delete;
  SmallFiles& operator=(const SmallFiles&) = delete;
  ~SmallFiles() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

/// A test with a folder of its own.
struct InScratch : testing::Test {
  const Scratch scratch;
  /// What `call` threw of bad data, files of the folder named from it on: "./a.tif: no such file".
  template <class Call>
  std::string data_fault(Call&& call) const {
    return scratch.from_here(fault_of<DataError>(call));
  }
  /// The same where no file may grow beyond `bytes`.
  template <class Call>
  std::string full_disk_fault(rlim_t bytes, Call&& call) const {
    const SmallFiles limit(bytes);
    return data_fault(call);
  }
};

/// The members of two objects, one by one.
template <class T, class... Member>
void expect_same(const T& a, const T& b, Member... member) {
  ([&] { EXPECT_EQ(a.*member, b.*member); }(), ...);
}

/// Whether a text holds each of the words.
inline testing::AssertionResult holds(const std::string& text, std::initializer_list<std::string> words) {
  for (const std::string& word : words)
    if (text.find(word) == std::string::npos) return testing::AssertionFailure() << word << " is not in\n" << text;
  return testing::AssertionSuccess() << "in\n" << text;
}

/// Whether a text begins with the words.
inline testing::AssertionResult begins(const std::string& text, const std::string& words) {
  return (text.starts_with(words) ? testing::AssertionSuccess() : testing::AssertionFailure())
         << words << " against the beginning of\n"
         << text;
}

/// The bytes of a sealed file without its seal, as a version before it would have left them.
inline std::string without_seal(const std::filesystem::path& file) {
  std::string bytes = text_of(file);
  bytes.resize(bytes.size() - 128);
  return bytes;
}

/// The bytes with one to eight of them changed, now and then cut short.
inline std::string damaged(std::string bytes, unsigned seed) {
  std::mt19937_64 random(seed);
  for (auto left = 1 + random() % 8; left > 0; --left)
    bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
  if (random() % 8 == 0) bytes.resize(random() % bytes.size());
  return bytes;
}

/// What a command prints (both streams); its exit code in `code`.
inline std::string output_of(const std::string& command, int* code = nullptr) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  while (pipe != nullptr && fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  const int status = pipe != nullptr ? pclose(pipe) : -1;
  if (code != nullptr) *code = status;
  return text;
}

inline bool has_tool(const std::string& check) { return std::system((check + " > /dev/null 2>&1").c_str()) == 0; }

/// What GDAL's own validator says of a cloud-optimised GeoTIFF; needs TALUS_NEED_TOOL(TALUS_COG_VALIDATOR).
inline void expect_valid_cog(const std::filesystem::path& file) {
  int code = -1;
  const auto said =
      output_of("/usr/bin/python3 -m osgeo_utils.samples.validate_cloud_optimized_geotiff --full-check=yes '" +
                    file.string() + "'",
                &code);
  EXPECT_EQ(code, 0) << said;
  EXPECT_NE(said.find("is a valid cloud optimized GeoTIFF"), std::string::npos) << said;
}
#define TALUS_COG_VALIDATOR \
  "/usr/bin/python3 -c 'import osgeo_utils.samples.validate_cloud_optimized_geotiff'", "python3-gdal"

/// A folder in which foreign tools make files.
struct Workshop : InScratch {
  std::string file(const std::string& name) const { return (scratch / name).string(); }
  /// Runs a command there that must work; what it says goes into log.txt.
  void shell(const std::string& command) const {
    const std::string quiet = "cd " + scratch.folder().string() + " && (" + command + ") > log.txt 2>&1";
    ASSERT_EQ(std::system(quiet.c_str()), 0) << command << "\n" << text_of(scratch / "log.txt");
  }
};

/// Skip aloud where a foreign tool is missing; fail where it was promised (TALUS_REQUIRE_TOOLS).
#define TALUS_NEED_TOOL(...) TALUS_NEED_TOOL_OF(__VA_ARGS__)
#define TALUS_NEED_TOOL_OF(check, package)                                                         \
  if (!talus::test::has_tool((check))) {                                                           \
    if (std::getenv("TALUS_REQUIRE_TOOLS") != nullptr) FAIL() << "missing: install " << (package); \
    GTEST_SKIP() << "SKIPPED: not checked by a foreign tool; install " << (package);               \
  }

}  // namespace talus::test
