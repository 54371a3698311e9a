// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/ascii_grid.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cmath>
#include <fstream>

#include "common/error.hpp"
#include "common/gis/ascii_header.hpp"
#include "common/gis/escaped_xml.hpp"
#include "common/stage/input_file.hpp"

namespace talus::gdal {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t longest_header = 16384;
constexpr std::size_t chunk = std::size_t{1} << 22;

std::string start_of(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";  // also what only GDAL knows: /vsizip/..., NETCDF:...
  std::ifstream stream(file, std::ios::binary);
  std::string start(longest_header, '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  require_read(stream, file);
  start.resize(static_cast<std::size_t>(stream.gcount()));
  return start;
}

/// Characters of cells that GDAL reads right: numbers with point or comma, nan and inf in any case, and what parts
/// them.
bool is_usual(unsigned char c) {
  static const auto table = [] {
    std::array<bool, 256> usual{};
    for (const char u : std::string("0123456789+-.,eE \t\r\n#nNaAiIfF()")) usual[static_cast<unsigned char>(u)] = true;
    usual[0x1a] = true;  // an end-of-file mark of old systems
    return usual;
  }();
  return table[c];
}

/// What single cells need: a word of their own, or commas that part them.
bool cells_need_rewriting(const fs::path& file, std::size_t body_at) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(body_at));
  std::string text(chunk, '\0');
  int commas = 0;  // in the word so far, as all that follows
  bool point = false, digits = false, signs = false;
  std::string letters;
  while (stream.read(text.data(), static_cast<std::streamsize>(text.size())), stream.gcount() > 0) {
    for (std::streamsize i = 0; i < stream.gcount(); ++i) {
      const auto c = static_cast<unsigned char>(text[static_cast<std::size_t>(i)]);
      if (!is_usual(c)) return true;
      if (c <= ' ') {
        // A word without digits: "nan" and "inf", which GDAL knows, or "NA" and "-", which it does not.
        if ((!letters.empty() || signs) && !digits && letters != "nan" && letters != "inf") return true;
        commas = 0, point = digits = signs = false;
        letters.clear();
        continue;
      }
      commas += c == ',';
      point = point || c == '.';
      digits = digits || (c >= '0' && c <= '9');
      if (std::isalpha(c) != 0) letters += static_cast<char>(std::tolower(c));
      signs = signs || c == '-' || c == '+';
      if (commas > 1 || (commas > 0 && point)) return true;
    }
  }
  require_read(stream, file);
  return false;
}

/// A file's cells, one word at a time, with where they stand.
class Words {
 public:
  Words(const fs::path& file, std::size_t at) : file_(file), stream_(file, std::ios::binary) {
    std::string start(at, '\0');
    stream_.read(start.data(), static_cast<std::streamsize>(at));
    for (const char c : start) line_ += c == '\n';
  }
  bool next(std::string& word) {
    word.clear();
    for (int c = stream_.get(); c != EOF; c = stream_.get()) {
      const bool parts = c <= ' ' || c == ';' || c == 0x1a;
      if (parts && !word.empty()) {
        if (c == '\n') stream_.unget();  // counted when the next word is looked for
        return true;
      }
      line_ += c == '\n';
      if (!parts) word += static_cast<char>(c);
    }
    require_read(stream_, file_);
    return !word.empty();
  }
  int line() const { return line_; }

 private:
  const fs::path& file_;
  std::ifstream stream_;
  int line_ = 1;
};

struct Rewriting {
  const fs::path& file;
  std::string nodata;
  std::string text;

  void add(const std::string& word, int line) {
    if (is_word_for_nodata(word)) {
      text += nodata;
    } else if (const auto value = ascii_number(word)) {
      text += std::isnan(*value) ? "nan" : fmt::format("{:.17g}", *value);
    } else {
      throw DataError({fmt::format("{}: line {}: \"{}\"", file.string(), line, word.substr(0, 40)),
                       "a cell of an ASCII grid is a number",
                       "Mend the line; cells without value hold the NODATA_value of the header, or *"});
    }
    text += ' ';
  }
  /// "1.5,2.25,3": commas that part cells. "1,5" is a number.
  void add_parted(const std::string& word, int line) {
    const auto commas = std::count(word.begin(), word.end(), ',');
    const bool part = commas > 1 || (commas == 1 && (word.find('.') != std::string::npos || word.back() == ','));
    if (!part) return add(word, line);
    std::size_t at = 0;
    while (at < word.size()) {
      const std::size_t end = std::min(word.find(',', at), word.size());
      if (end > at) add(word.substr(at, end - at), line);
      at = end + 1;
    }
  }
};

std::string rewritten(const fs::path& file, const AsciiHeader& header) {
  Rewriting rewriting{file, header.nodata.empty() ? "nan" : header.nodata, header.text};
  Words words(file, header.body_at);
  for (std::string word; words.next(word);) rewriting.add_parted(word, words.line());
  return std::move(rewriting.text);
}

/// The start of one text, then a region of a file, as GDAL's /vsisparse/ reads them.
std::string sparse(const std::string& head, std::size_t head_size, const fs::path& file, std::size_t from,
                   std::size_t size) {
  const auto region = [](const std::string& name, std::size_t to, std::size_t at, std::size_t length) {
    return fmt::format(
        "<SubfileRegion><Filename relative=\"0\">{}</Filename><DestinationOffset>{}</DestinationOffset>"
        "<SourceOffset>{}</SourceOffset><RegionLength>{}</RegionLength></SubfileRegion>",
        escaped_xml(name), to, at, length);
  };
  return fmt::format("<VSISparseFile><Length>{}</Length>{}{}</VSISparseFile>", head_size + size,
                     head_size > 0 ? region(head, 0, 0, head_size) : "",
                     region(fs::absolute(file).string(), head_size, from, size));
}

/// DEM.prj beside DEM.asc, in either case of its letters; empty = none.
fs::path projection_beside(const fs::path& file) {
  for (const char* extension : {".prj", ".PRJ"}) {
    fs::path beside = file;
    beside.replace_extension(extension);
    std::error_code error;
    if (fs::is_regular_file(beside, error)) return beside;
  }
  return {};
}

}  // namespace

bool begins_as_ascii_grid(const fs::path& file) { return ascii_header(start_of(file)).has_value(); }

AsciiGrid::AsciiGrid(const fs::path& file) : path_(file.string()) {
  const auto header = ascii_header(start_of(file));
  if (!header) return;
  is_one_ = true;
  if (cells_need_rewriting(file, header->body_at)) {
    stand_in(file, rewritten(file, *header));
  } else if (!header->usual) {
    stand_in(file, header->text, header->body_at);
  }
}

AsciiGrid::~AsciiGrid() {
  if (!folder_.empty()) VSIRmdirRecursive(folder_.c_str());
}

void AsciiGrid::put(const std::string& name, std::string text) {
  if (folder_.empty()) {
    static std::atomic<int> count{0};
    folder_ = fmt::format("/vsimem/talus-ascii-{}", count++);
  }
  VSILFILE* file = VSIFOpenL((folder_ + "/" + name).c_str(), "wb");
  const bool written = file != nullptr && VSIFWriteL(text.data(), 1, text.size(), file) == text.size();
  if (file != nullptr) VSIFCloseL(file);
  if (!written) throw DataError({path_ + ": cannot be put into memory", "", "Save it as a GeoTIFF: gdal_translate"});
}

void AsciiGrid::stand_in(const fs::path& file, const std::string& header, std::size_t body_at) {
  const std::size_t size = fs::file_size(file) - body_at;
  put("header", header);
  put("grid.asc", sparse(folder_ + "/header", header.size(), file, body_at, size));
  if (const fs::path prj = projection_beside(file); !prj.empty())
    put("grid.prj", sparse("", 0, prj, 0, fs::file_size(prj)));
  path_ = "/vsisparse/" + folder_ + "/grid.asc";
}

void AsciiGrid::stand_in(const fs::path& file, std::string text) {
  put("grid.asc", std::move(text));
  if (const fs::path prj = projection_beside(file); !prj.empty()) put("grid.prj", start_of(prj));
  path_ = folder_ + "/grid.asc";
}

}  // namespace talus::gdal
