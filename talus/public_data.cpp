// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/commands.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <functional>
#include <iterator>
#include <map>

#include "common/gis/crs.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/raster_file.hpp"
#include "common/map/statistics.hpp"
#include "common/recipe/suggest.hpp"
#include "common/recipe/toml.hpp"
#include "common/stage/files.hpp"
#include "common/stage/stage.hpp"

namespace talus::command {
namespace fs = std::filesystem;
namespace {

/// Of the range of a file's values: what is stored in single precision differs by less, another file by more.
constexpr double alike = 1e-6;

/// A file of an example, and what it must hold.
struct DataFile {
  std::string name;
  std::vector<std::string> sum;  ///< names of its sources
  std::string copy;              ///< the source that it is, byte by byte, instead of a sum
  std::string sha256;            ///< of the file as it was made once; empty: not known
  double cells = 0, smallest = 0, largest = 0, mean = 0;
};

struct Source {
  std::string name;
  std::string folder;  ///< below that of the example; empty: in it
  std::string sha256;  ///< empty: not known
  std::string place() const { return folder.empty() ? name : folder + "/" + name; }
};

struct Example {
  std::map<std::string, std::string>
      words;  ///< title, folder, licence, repository, commit, url, crs, checksums, note...
  std::vector<Source> sources;
  std::vector<DataFile> files;
  std::string word(const char* name) const {
    const auto found = words.find(name);
    return found == words.end() ? "" : found->second;
  }
};
using Examples = std::map<std::string, Example>;

std::string text_in(const toml::table& table, const char* key) { return table[key].value_or(std::string()); }

void for_each_table(const toml::array* tables, const std::function<void(const toml::table&)>& take) {
  if (tables == nullptr) return;
  for (const toml::node& item : *tables)
    if (const toml::table* table = item.as_table()) take(*table);
}

Example example_of(const toml::table& table) {
  Example example;
  for (const auto& [key, value] : table)
    if (const auto text = value.value<std::string>()) example.words[std::string(key.str())] = *text;
  for_each_table(table["sources"].as_array(), [&](const toml::table& source) {
    example.sources.push_back({text_in(source, "name"), text_in(source, "folder"), text_in(source, "sha256")});
  });
  for_each_table(table["file"].as_array(), [&](const toml::table& file) {
    DataFile made{text_in(file, "name"), {}, text_in(file, "copy"), text_in(file, "sha256")};
    made.cells = file["cells"].value_or(0.0);
    made.smallest = file["smallest"].value_or(0.0);
    made.largest = file["largest"].value_or(0.0);
    made.mean = file["mean"].value_or(0.0);
    if (const toml::array* sum = file["sum"].as_array())
      for (const toml::node& name : *sum) made.sum.push_back(name.value_or(std::string()));
    for (Source& source : example.sources)
      if (source.name == made.copy && source.sha256.empty()) source.sha256 = made.sha256;
    example.files.push_back(std::move(made));
  });
  return example;
}

/// Where files of a repository at a commit lie, as bytes.
std::string address_of(const Example& example) {
  const std::string github = "https://github.com/", repository = example.word("repository");
  if (!example.word("url").empty() || !repository.starts_with(github)) return example.word("url");
  return fmt::format("https://raw.githubusercontent.com/{}/{}/{}", repository.substr(github.size()),
                     example.word("commit"), example.word("path"));
}

Examples read_examples(const fs::path& file) {
  Examples examples;
  try {
    const toml::table root = file.empty() ? toml::parse(public_data_table()) : toml::parse_file(file.string());
    for (const auto& [name, node] : root)
      if (const toml::table* table = node.as_table()) examples[std::string(name.str())] = example_of(*table);
    for (auto& [name, example] : examples) example.words["url"] = address_of(example);
  } catch (const toml::parse_error& error) {
    throw DataError(Fault{file.string() + ": this is no table of examples", std::string(error.description()), ""});
  }
  return examples;
}

std::string how_made(const DataFile& file) {
  std::string text = file.name + " = " + file.copy;
  for (std::size_t i = 0; i < file.sum.size(); ++i) text += (i == 0 ? "" : " + ") + file.sum[i];
  return text;
}

std::string checksum_words(const std::string& sha256) { return "  sha256 " + (sha256.empty() ? "not known" : sha256); }

/// What is said of an example, in the list and in SOURCE.md.
std::string description(const std::string& name, const Example& example) {
  std::string text = fmt::format("{}: {}\n", name, example.word("title"));
  for (const char* key : {"licence", "repository", "commit", "url", "crs", "checksums", "note"})
    if (!example.word(key).empty()) text += fmt::format("  {}: {}\n", key, example.word(key));
  for (const Source& source : example.sources)
    text += fmt::format("  source: {}{}\n", source.place(), checksum_words(source.sha256));
  for (const DataFile& file : example.files)
    text += fmt::format("  made: {}{}\n", how_made(file), checksum_words(file.sha256));
  return text;
}

/// Whether a raster holds what the file must hold; empty: it does.
std::string difference_from(const Raster& raster, const DataFile& wanted) {
  double count = 0, smallest = 1e300, largest = -1e300;
  Sum sum;
  for (const double value : raster.values) {
    if (!std::isfinite(value)) continue;
    ++count;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
    sum.add(value);
  }
  const double mean = count > 0 ? sum.value() / count : 0;
  const double near = alike * std::max({std::abs(wanted.smallest), std::abs(wanted.largest), 1e-3});
  const auto same = [](double a, double b, double within) { return std::abs(a - b) <= within; };
  // The table has six digits of the extremes, and eight of the mean, which tells the rest.
  if (count == wanted.cells && same(smallest, wanted.smallest, 5 * near) && same(largest, wanted.largest, 5 * near) &&
      same(mean, wanted.mean, near))
    return "";
  return fmt::format(
      "it has {} cells, {:.6g} to {:.6g}, mean {:.8g}; wanted are {} cells, {:.6g} to {:.6g}, mean {:.8g}", count,
      smallest, largest, mean, wanted.cells, wanted.smallest, wanted.largest, wanted.mean);
}

/// Refuses, where the user insists on checksums, what none is known of.
void expect_checksum(const std::string& name, const std::string& sha256, bool exact) {
  if (exact && sha256.empty())
    throw DataError(Fault{name + ": no SHA-256 of it is known", "--exact was asked for",
                          "Leave --exact out: what is made is compared with what it must hold all the same"});
}

/// Whether a file is that of the table to the byte. Another one that holds the same values, as another version of GDAL
/// writes it, is warned of, or refused where the user insists.
void check_bytes(const fs::path& path, const DataFile& file, bool exact) {
  expect_checksum(file.name, file.sha256, exact);
  const std::string found = sha256(path);
  if (file.sha256.empty() || found == file.sha256) return;
  const std::string what = path.string() + ": other bytes than the file of the example",
                    which = fmt::format("its SHA-256 is {}, wanted is {}", found, file.sha256);
  if (!file.copy.empty()) throw DataError(Fault{what, which, "Fetch it again"});
  if (exact)
    throw DataError(Fault{what, which + "; --exact was asked for",
                          "Leave --exact out: number of cells, extremes and mean are those of the example"});
  log_warning(fmt::format("{} ({}); number of cells, extremes and mean are the same. --exact refuses it", what, which));
}

/// Runs a program to its end. True where it ended well.
bool run_to_end(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid(), process = ::fork();
  if (process < 0) return false;
  if (process == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a program must not outlive this one, even where it is killed
    if (::getppid() == parent) ::execve(arguments[0], arguments.data(), environ);
    ::_exit(127);
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void fetch(const std::string& url, const fs::path& file) {
  const char* const curl = "/usr/bin/curl";
  if (!fs::exists(curl))
    throw DataError(Fault{"the program curl is missing", "it fetches the sources",
                          fmt::format("apt-get install curl; or fetch {} by other means, and give its folder with "
                                      "--from DIR",
                                      url)});
  const TemporaryFolder folder("talus-data");
  const fs::path errors = folder.path() / "errors";
  if (run_to_end({curl, "--fail", "--silent", "--show-error", "--location", "--stderr", errors.string(), "--output",
                  file.string(), url}))
    return;
  const std::string reason = text_if_there(errors).value_or("");
  throw DataError(Fault{url + ": cannot be fetched", reason.substr(0, reason.find('\n')),
                        "Fetch it by other means, and give its folder with --from DIR"});
}

/// The sources of an example in a folder, checked.
void get_sources(const Example& example, const fs::path& from, const fs::path& into, bool exact) {
  for (const Source& source : example.sources) {
    expect_checksum(source.name, source.sha256, exact);
    const std::string url = fmt::format("{}/{}", example.word("url"), source.place());
    const fs::path file = into / source.name;
    if (from.empty()) {
      log_info("fetching " + url);
      fetch(url, file);
    } else if (fs::exists(from / source.name)) {
      fs::copy_file(from / source.name, file);
    } else if (fs::exists(from / source.place())) {
      fs::copy_file(from / source.place(), file);
    } else {
      throw DataError(Fault{(from / source.name).string() + ": no such file",
                            "neither the sources nor all files made of them are in that folder",
                            "Fetch it from " + url});
    }
    const std::string found = sha256(file);
    if (!source.sha256.empty() && found != source.sha256)
      throw DataError(Fault{source.name + ": other bytes than the example was made of",
                            fmt::format("its SHA-256 is {}, wanted is {}", found, source.sha256),
                            "Fetch it from " + url});
    log_info(fmt::format("{}  sha256 {}", source.name, found));
  }
}

Raster sum_of(const DataFile& file, const Example& example, const fs::path& sources) {
  Raster sum;
  for (const std::string& name : file.sum) {
    Raster next = read_raster(sources / name);
    if (sum.values.empty()) {
      sum = std::move(next);
      continue;
    }
    if (next.values.size() != sum.values.size() || next.grid.columns != sum.grid.columns)
      throw DataError(
          Fault{fmt::format("{}: another grid than that of {}", name, file.sum.front()), "", "Fetch both again"});
    for (std::size_t i = 0; i < sum.values.size(); ++i)
      if (std::isfinite(next.values[i])) sum.values[i] += next.values[i];
  }
  if (!example.word("crs").empty()) sum.grid.crs_wkt = crs_by_name(example.word("crs"));
  return sum;
}

/// Takes the files of an example as they lie in a folder, where all are there. False: not all are.
bool take_made(const Example& example, const fs::path& from, const fs::path& out, bool exact) {
  const auto is_there = [&](const DataFile& file) { return fs::exists(from / file.name); };
  if (from.empty() || !std::all_of(example.files.begin(), example.files.end(), is_there)) return false;
  for (const DataFile& file : example.files) {
    if (file.copy.empty())
      if (const std::string other = difference_from(read_raster(from / file.name), file); !other.empty())
        throw DataError(Fault{(from / file.name).string() + ": not that file of the example", other,
                              "Give another folder, or leave --from out to fetch the sources"});
    check_bytes(from / file.name, file, exact);
    if (!fs::equivalent(from, out))
      fs::copy_file(from / file.name, out / file.name, fs::copy_options::overwrite_existing);
  }
  return true;
}

void make_files(const Example& example, const fs::path& sources, const fs::path& out) {
  for (const DataFile& file : example.files) {
    if (!file.copy.empty()) {
      fs::copy_file(sources / file.copy, out / file.name, fs::copy_options::overwrite_existing);
      check_bytes(out / file.name, file, false);
      continue;
    }
    const Raster raster = sum_of(file, example, sources);
    if (const std::string other = difference_from(raster, file); !other.empty())
      throw DataError(Fault{file.name + ": what was made of its sources is not that file of the example", other,
                            "The sources have changed or are not whole: fetch them again"});
    write_geotiff(out / file.name, raster, {how_made(file), "m", {{"SOURCE", example.word("url")}}});
  }
}

const Example& chosen(const Examples& examples, const std::string& name) {
  const auto found = examples.find(name);
  if (found != examples.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [one, unused] : examples) known.push_back(one);
  throw RecipeError(Fault{name + ": no such example", "", recipe::did_you_mean(name, known)});
}

}  // namespace

int make_data(const DataRequest& request) {
  const Examples examples = read_examples(request.table);
  if (request.name.empty()) {
    for (const auto& [name, example] : examples) fmt::print("{}\n", description(name, example));
    return 0;
  }
  const Example& example = chosen(examples, request.name);
  const fs::path out = request.out / example.word("folder");
  make_folder(out);
  if (!take_made(example, request.from, out, request.exact)) {
    const TemporaryFolder sources("talus-data");
    get_sources(example, request.from, sources.path(), request.exact);
    make_files(example, sources.path(), out);
  }
  std::string here;
  for (const DataFile& file : example.files)
    here += fmt::format("  here: {}  sha256 {}\n", file.name, sha256(out / file.name));
  write_text(out / "SOURCE.md", "# " + description(request.name, example) + here);
  for (const DataFile& file : example.files) fmt::print("{}\n", (out / file.name).string());
  if (!example.word("pipeline").empty())
    log_info(fmt::format("Now: TALUS_DATA={} talus run .../pipelines/{}/recipe.toml",
                         fs::absolute(request.out).string(), example.word("pipeline")));
  return 0;
}

}  // namespace talus::command
