// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/ascii_grid.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/escaped_xml.hpp"
#include "common/stage/files.hpp"
#include "common/table_words.hpp"
#include "common/text_encoding.hpp"

namespace talus {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
  return result;
}

/// "1,5" and "1.5D3" as people mean them; nullopt when it is no number.
std::optional<double> ascii_number(std::string_view word) {
  std::string plain(word);
  for (char& c : plain) {
    if (c == ',') c = '.';
    if (c == 'd' || c == 'D') c = 'e';
  }
  const char* begin = plain.data() + (plain.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(begin, plain.data() + plain.size(), value);
  if (error == std::errc() && end == plain.data() + plain.size()) return value;
  return word.find("#IND") != word.npos || word.find("#QNAN") != word.npos ? std::optional(std::nan("")) : std::nullopt;
}

/// "*", "NA", "null" and the like.
bool is_word_for_nodata(std::string_view word) {
  const std::string text = lower(word);
  return text == "*" || text == "-" || text == "--" || text == "na" || text == "n/a" || text == "null" ||
         text == "none" || text == "nodata" || text == "void";
}

/// One name for each thing that a header says, by all the names it goes by.
std::string_view meaning_of(const std::string& key) {
  static constexpr std::pair<std::string_view, std::string_view> names[] = {
      {"columns", " ncols nbcols ncolumns mx "},
      {"rows", " nrows nbrows nlines my "},
      {"west", " xllcorner xulcorner "},
      {"south", " yllcorner "},
      {"north", " yulcorner "},
      {"first x", " xllcenter xllcentre xulcenter xulcentre xlower xll "},
      {"lowest y", " yllcenter yllcentre ylower yll "},
      {"highest y", " yulcenter yulcentre "},
      {"cell", " cellsize "},
      {"dx", " dx xdim "},
      {"dy", " dy ydim "},
      {"nodata", " nodata_value nodata no_data_value no_data nodatavalue missing_value missing "}};
  for (const auto& [meaning, keys] : names)
    if (keys.find(" " + key + " ") != std::string_view::npos) return meaning;
  return {};
}

/// The keys that GDAL's driver itself knows.
bool gdal_knows(const std::string& key) {
  constexpr std::string_view keys = " ncols nrows xllcorner yllcorner xllcenter yllcenter dx dy cellsize nodata_value ";
  return keys.find(" " + key + " ") != std::string_view::npos;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words(1);
  for (const char c : line) {
    const bool parts = std::isspace(static_cast<unsigned char>(c)) != 0 || c == ':' || c == '=';
    if (!parts) words.back() += c;
    if (parts && !words.back().empty()) words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool begins_a_key(const std::string& word) {
  return std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !is_word_for_nodata(word) &&
         !lower(word).starts_with("nan") && !lower(word).starts_with("inf");
}

/// Words of a line of the header, the key first. GeoClaw has it last: "60 mx", "10 10 cellsize".
std::vector<std::string> key_first(std::vector<std::string> words) {
  std::rotate(words.begin(), words.end() - 1, words.end());
  return words;
}

/// Lines of the header, gathered by meaning.
struct Gathered {
  AsciiHeader header;
  bool keys_last = false;  ///< as GeoClaw writes them
  std::map<std::string_view, std::string> values;
  bool first = true;

  void take(std::string_view line) {
    std::vector<std::string> words = words_of(line);
    if (keys_last) words = key_first(std::move(words));
    header.usual = header.usual && !keys_last;
    const std::string key = lower(words.front());
    const std::string_view meaning = meaning_of(key);
    // GDAL looks for a known key at the very start, and wants blanks between key and value.
    header.usual = header.usual && gdal_knows(key) && line.find_first_of(":=") == std::string_view::npos &&
                   std::isalpha(static_cast<unsigned char>(line.front())) != 0 && !(first && meaning == "nodata");
    first = false;
    if (meaning.empty() || words.size() < 2) return;
    header.usual = header.usual && lower(words[1]).find('d') == std::string::npos;
    values[meaning] = words[1];
    if (meaning == "cell" && words.size() > 2 && ascii_number(words[2])) {
      values["dx"] = words[1];
      values["dy"] = words[2];
    }
  }

  std::optional<double> number(std::string_view meaning) const {
    const auto found = values.find(meaning);
    return found == values.end() ? std::nullopt : ascii_number(found->second);
  }
};

std::optional<double> west_of(const Gathered& g, double dx) {
  if (const auto west = g.number("west")) return west;
  const auto x = g.number("first x");
  return x ? std::optional(*x - 0.5 * dx) : std::nullopt;
}

std::optional<double> south_of(const Gathered& g, double dy, double rows) {
  if (const auto south = g.number("south")) return south;
  if (const auto y = g.number("lowest y")) return *y - 0.5 * dy;
  if (const auto north = g.number("north")) return *north - rows * dy;
  const auto y = g.number("highest y");
  return y ? std::optional(*y + 0.5 * dy - rows * dy) : std::nullopt;
}

std::optional<AsciiHeader> written(Gathered&& g) {
  const auto columns = g.number("columns"), rows = g.number("rows");
  const auto cell = g.number("cell");
  const auto dx = g.number("dx") ? g.number("dx") : cell;
  const auto dy = g.number("dy") ? g.number("dy") : cell ? cell : dx;  // GeoClaw names one of square cells
  if (!columns || !rows || !dx || !dy) return std::nullopt;
  const auto west = west_of(g, *dx), south = south_of(g, *dy, *rows);
  if (!west || !south) return std::nullopt;
  const bool one_kind = g.values.contains("west") == g.values.contains("south");
  AsciiHeader header = std::move(g.header);
  header.columns = *columns;
  header.rows = *rows;
  header.usual = header.usual && one_kind;
  header.text =
      fmt::format("ncols {:.0f}\nnrows {:.0f}\nxllcorner {:.17g}\nyllcorner {:.17g}\n", *columns, *rows, *west, *south);
  header.text +=
      *dx == *dy ? fmt::format("cellsize {:.17g}\n", *dx) : fmt::format("dx {:.17g}\ndy {:.17g}\n", *dx, *dy);
  if (const auto nodata = g.values.find("nodata"); nodata != g.values.end()) {
    const auto value = ascii_number(nodata->second);
    header.nodata = value ? fmt::format("{:.17g}", *value) : "nan";
    header.text += "NODATA_value " + header.nodata + "\n";
  }
  return header;
}

}  // namespace

std::optional<AsciiHeader> ascii_header(std::string_view start) {
  Gathered gathered;
  std::size_t at = 0;
  if (start.starts_with("\xEF\xBB\xBF")) at = 3, gathered.header.usual = false;
  while (at < start.size()) {
    const std::size_t end = std::min(start.find_first_of("\r\n", at), start.size());
    const std::string_view line = start.substr(at, end - at);
    const std::vector<std::string> words = words_of(line);
    const bool comment =
        !words.empty() && (words[0].starts_with('#') || words[0].starts_with("//") || words[0].starts_with(';'));
    if (comment || (words.empty() && gathered.first)) gathered.header.usual = false;
    if (!words.empty() && !comment) {
      // "NODATA -9999" is a key though a cell may say NODATA too.
      const bool last = words.size() > 1 && ascii_number(words[0]) && !meaning_of(lower(words.back())).empty();
      if (gathered.first) gathered.keys_last = last;
      const bool key = gathered.keys_last
                           ? last
                           : begins_a_key(words[0]) || (words.size() == 2 && !meaning_of(lower(words[0])).empty());
      if (!key) break;
      gathered.take(line);
    }
    at = end + 1;
  }
  gathered.header.body_at = std::min(at, start.size());
  return written(std::move(gathered));
}

}  // namespace talus

namespace talus::gdal {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t longest_header = 16384;
constexpr std::size_t chunk = std::size_t{1} << 22;

/// Characters of cells that GDAL reads right: numbers with point or comma, nan and inf, and what parts them.
bool is_usual(unsigned char c) {
  static const auto table = [] {
    std::array<bool, 256> usual{};
    for (const char u : std::string("0123456789+-.,eE \t\r\n#nNaAiIfF()")) usual[static_cast<unsigned char>(u)] = true;
    usual[0x1a] = true;  // an end-of-file mark of old systems
    return usual;
  }();
  return table[c];
}

/// What the cells of a file are like.
struct Cells {
  bool need_rewriting = false;  ///< a word of their own, or commas that part them
  bool have_commas = false;
  double count = 0;  ///< known where they need no rewriting
};

Cells look_at_cells(const fs::path& file, std::size_t body_at) {
  Cells cells;
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(body_at));
  std::string text(chunk, '\0');
  int commas = 0;  // in the word so far, as all that follows
  bool point = false, digits = false, signs = false, in_word = false;
  std::string letters;
  while (stream.read(text.data(), static_cast<std::streamsize>(text.size())), stream.gcount() > 0) {
    for (std::streamsize i = 0; i < stream.gcount(); ++i) {
      const auto c = static_cast<unsigned char>(text[static_cast<std::size_t>(i)]);
      cells.need_rewriting = !is_usual(c);
      if (cells.need_rewriting) return cells;
      if (c <= ' ') {
        cells.count += in_word ? 1 : 0;
        in_word = false;
        // A word without digits: "nan" and "inf", which GDAL knows, or "NA" and "-", which it does not.
        cells.need_rewriting = (!letters.empty() || signs) && !digits && letters != "nan" && letters != "inf";
        if (cells.need_rewriting) return cells;
        commas = 0, point = digits = signs = false;
        letters.clear();
        continue;
      }
      in_word = c != 0x1a;
      commas += c == ',';
      cells.have_commas = cells.have_commas || c == ',';
      point = point || c == '.';
      digits = digits || (c >= '0' && c <= '9');
      if (std::isalpha(c) != 0) letters += static_cast<char>(std::tolower(c));
      signs = signs || c == '-' || c == '+';
      cells.need_rewriting = commas > 1 || (commas > 0 && point);
      if (cells.need_rewriting) return cells;
    }
  }
  cells.count += in_word ? 1 : 0;
  require_read(stream, file);
  return cells;
}

/// A file's cells, one word at a time, with where they stand.
class Words {
 public:
  Words(const fs::path& file, std::size_t at) : file_(file), stream_(file, std::ios::binary) {
    std::string start(at, '\0');
    stream_.read(start.data(), static_cast<std::streamsize>(at));
    for (const char c : start) count(c);
  }
  bool next(std::string& word) {
    word.clear();
    for (int c = stream_.get(); c != EOF; c = stream_.get()) {
      const bool parts = c <= ' ' || c == ';' || c == 0x1a;
      if (parts && !word.empty()) {
        if (c == '\n') stream_.unget();  // counted when the next word is looked for
        if (c != '\n') count(c);
        return true;
      }
      count(c);
      if (parts) continue;
      if (word.empty()) begin_ = column_;
      word += static_cast<char>(c);
    }
    require_read(stream_, file_);
    return !word.empty();
  }
  int line() const { return line_; }
  std::size_t column() const { return begin_; }  ///< where the word begins, from 1

 private:
  void count(int c) {
    line_ += c == '\n';
    column_ = c == '\n' ? 0 : column_ + 1;
  }

  const fs::path& file_;
  std::ifstream stream_;
  int line_ = 1;
  std::size_t column_ = 0, begin_ = 1;
};

[[noreturn]] void refuse_cell(const fs::path& file, const Words& words, const std::string& word, const std::string& why,
                              const std::string& mend) {
  throw DataError({fmt::format("{}: line {}, column {}: \"{:.40}\"", file.string(), words.line(), words.column(), word),
                   why, mend});
}

/// Refuses a file of more cells than its header names, at the first line that has more than a row, else at the first
/// cell too many.
[[noreturn]] void refuse_surplus(const fs::path& file, const AsciiHeader& header, double count) {
  const std::string why = fmt::format(
      "with it the cells are {:.0f}, and the header names {:.0f} x {:.0f}: a sign that parts thousands makes "
      "two cells of one, or the header is of another grid",
      count, header.columns, header.rows);
  for (const bool by_line : {true, false}) {
    Words words(file, header.body_at);
    double all = 0, of_line = 0;
    int line = 0;
    for (std::string word; words.next(word); line = words.line()) {
      const double cells = 1 + static_cast<double>(std::count(word.begin(), word.end(), ','));
      of_line = cells + (words.line() == line ? of_line : 0);
      all += cells;
      if (by_line ? of_line > header.columns : all > header.columns * header.rows)
        refuse_cell(file, words, word, why, "Write thousands without a sign, or mend ncols and nrows");
    }
  }
  throw DataError({file.string() + ": more cells than its header names", why, "Mend ncols and nrows"});
}

/// Refuses decimal commas that could all part thousands, and those beside decimal points.
void check_commas(const fs::path& file) {
  NumberDoubts doubts;
  const auto refuse = [&](const NumberDoubt& doubt) {
    throw DataError(
        {fmt::format("{}: line {}, column {}: \"{:.40}\"", file.string(), doubt.line, doubt.column, doubt.written),
         doubt.why, doubt.mend});
  };
  Words words(file, 0);
  for (std::string word; words.next(word);)
    if (ascii_number(word))
      if (const auto doubt = doubts.look(word, words.line(), words.column())) refuse(*doubt);
  if (const auto doubt = doubts.left()) refuse(*doubt);
}

struct Rewriting {
  const fs::path& file;
  std::string nodata;
  std::string text;
  double count = 0;  ///< of cells

  void add(const std::string& word, const Words& words) {
    ++count;
    if (is_word_for_nodata(word)) {
      text += nodata;
    } else if (const auto value = ascii_number(word)) {
      text += std::isnan(*value) ? "nan" : fmt::format("{:.17g}", *value);
    } else {
      refuse_cell(file, words, word,
                  is_grouped(word) ? "a cell is a number without a sign that parts thousands"
                                   : "a cell of an ASCII grid is a number",
                  "Mend the line; cells without value hold the NODATA_value of the header, or *");
    }
    text += ' ';
  }
  /// "1.5,2.25,3": commas that part cells. "1,5" is a number.
  void add_parted(const std::string& word, const Words& words) {
    const auto commas = std::count(word.begin(), word.end(), ',');
    const bool part = commas > 1 || (commas == 1 && (word.find('.') != std::string::npos || word.back() == ','));
    if (!part) return add(word, words);
    std::size_t at = 0;
    while (at < word.size()) {
      const std::size_t end = std::min(word.find(',', at), word.size());
      if (end > at) add(word.substr(at, end - at), words);
      at = end + 1;
    }
  }
};

std::string rewritten(const fs::path& file, const AsciiHeader& header) {
  Rewriting rewriting{file, header.nodata.empty() ? "nan" : header.nodata, header.text};
  Words words(file, header.body_at);
  for (std::string word; words.next(word);) rewriting.add_parted(word, words);
  if (rewriting.count > header.columns * header.rows) refuse_surplus(file, header, rewriting.count);
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

/// Whether the bytes of UTF-16 or UTF-32 behind its mark are plain letters, as those of a grid are: heights as binary
/// integers may begin like it.
bool is_plain_but_wide(const std::string& start) {
  return std::all_of(start.begin(), start.end(), [](unsigned char c) {
    return c == '\0' || c >= 0xFE || c == '\t' || c == '\n' || c == '\r' || (c >= ' ' && c <= '~');
  });
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

bool begins_as_ascii_grid(const fs::path& file) { return ascii_header(start_of(file, longest_header)).has_value(); }

AsciiGrid::AsciiGrid(const fs::path& file) : path_(file.string()) {
  const std::string start = start_of(file, longest_header);
  if (const std::string_view encoding = wide_encoding(start); !encoding.empty() && is_plain_but_wide(start))
    throw DataError({fmt::format("{}: its text is {}", path_, encoding), "a grid of text is wanted as UTF-8",
                     mend_of_encoding(encoding, path_)});
  const auto header = ascii_header(start);
  if (!header) return;
  is_one_ = true;
  const Cells cells = look_at_cells(file, header->body_at);
  if (cells.need_rewriting) {
    stand_in(file, rewritten(file, *header));
    return;
  }
  if (cells.count > header->columns * header->rows) refuse_surplus(file, *header, cells.count);
  if (cells.have_commas) check_commas(file);
  if (!header->usual) stand_in(file, header->text, header->body_at);
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
  if (const fs::path prj = projection_beside(file); !prj.empty()) put("grid.prj", start_of(prj, longest_header));
  path_ = folder_ + "/grid.asc";
}

}  // namespace talus::gdal
