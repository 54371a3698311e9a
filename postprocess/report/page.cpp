// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/report/page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "common/deflate.hpp"
#include "common/gis/escaped_xml.hpp"
#include "common/recipe/paths.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/picture/picture.hpp"

namespace talus::postprocess {
namespace {

/// JSON inside <script>: no "<" may stand there, or a title could end the block.
std::string for_script(const Json& json) {
  const auto text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe.append("\\u003c") : safe.append(1, c);
  return safe;
}

/// The sources of a Content-Security-Policy for what stands between `open` and `close`: "'sha256-..' 'sha256-..'".
std::string hashes(std::string_view page, std::string_view open, std::string_view close) {
  std::string words;
  for (std::size_t at = page.find(open); at != std::string_view::npos; at = page.find(open, at)) {
    at += open.size();
    const std::size_t end = page.find(close, at);
    words += (words.empty() ? "" : " ") + policy_source(page.substr(at, end - at));
  }
  return words;
}

/// The page with its slots filled. They are looked for in the page itself and never in what fills them.
std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& slots) {
  std::string text;
  for (const auto& [slot, words] : slots) {
    const auto at = page.find(slot);
    if (at == std::string_view::npos) throw std::logic_error("the page has no " + std::string(slot));
    text += std::string(page.substr(0, at)) + words;
    page.remove_prefix(at + slot.size());
  }
  return text + std::string(page);
}

constexpr double most = 65534;  // of 65536: 0 is NaN

/// One number for the cells of a block of `factor` x `factor` from (column, row) on, NaN left out.
double merged(const Raster& raster, int column, int row, int factor, MergedCells merge) {
  double all = nan;
  int count = 0;
  for (int r = row; r < std::min(row + factor, raster.grid.rows); ++r)
    for (int c = column; c < std::min(column + factor, raster.grid.columns); ++c) {
      const double value = raster.at(c, r);
      if (std::isnan(value)) continue;
      all = count++ == 0                    ? value
            : merge == MergedCells::mean    ? all + value
            : merge == MergedCells::largest ? std::max(all, value)
                                            : std::min(all, value);
    }
  return merge == MergedCells::mean && count > 0 ? all / count : all;
}

}  // namespace

std::string policy_source(std::string_view inline_text) {
  const std::string hex = sha256_of_text(std::string(inline_text));
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return fmt::format("'sha256-{}'", base64(bytes));
}

void leave_out_folders(Json& json) {
  if (json.is_string()) json = without_absolute_paths(json.get<std::string>());
  if (!json.is_structured()) return;
  for (Json& item : json) leave_out_folders(item);
}

std::string filled_page(std::string_view page, const std::string& title, const Json& data) {
  return filled(page, {{"@HASHES_OF_SCRIPTS@", hashes(page, "<script>", "</script>")},
                       {"@HASHES_OF_STYLES@", hashes(page, "<style>", "</style>")},
                       {"@TITLE@", escaped_xml(title)},
                       {"@DATA@", for_script(data)}});
}

Raster cut(const Raster& raster, const Window& window) {
  const auto& grid = raster.grid;
  const auto cell_of = [&](double metres, int count, double slack) {
    return std::clamp(static_cast<int>(std::floor(metres / grid.cell + slack)), 0, count - 1);
  };
  constexpr double slack = 1e-6;  // a window that ends where a cell does leaves the next one out
  const int first = cell_of(window.west - grid.west, grid.columns, slack),
            last = cell_of(window.east - grid.west, grid.columns, -slack);
  const int bottom = cell_of(window.south - grid.south, grid.rows, slack),
            top = cell_of(window.north - grid.south, grid.rows, -slack);
  return cut(raster, CellWindow{first, bottom, last - first + 1, top - bottom + 1});
}

Raster coarsened(const Raster& raster, int factor, MergedCells merge) {
  if (factor == 1) return raster;
  const auto& grid = raster.grid;
  Raster coarse{grid, {}};
  coarse.grid.columns = (grid.columns + factor - 1) / factor;
  coarse.grid.rows = (grid.rows + factor - 1) / factor;
  coarse.grid.cell = grid.cell * factor;
  coarse.values.reserve(coarse.grid.count());
  for (int row = 0; row < coarse.grid.rows; ++row)
    for (int column = 0; column < coarse.grid.columns; ++column)
      coarse.values.push_back(merged(raster, column * factor, row * factor, factor, merge));
  return coarse;
}

int factor_for(const MapGrid& grid, std::size_t cells) {
  int factor = 1;
  while (static_cast<std::size_t>((grid.columns + factor - 1) / factor) *
             static_cast<std::size_t>((grid.rows + factor - 1) / factor) >
         cells)
    ++factor;
  return factor;
}

Json packed(const std::vector<std::vector<double>>& frames) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::size_t count = 0;
  for (const auto& values : frames) {
    count += values.size();
    for (const double v : values) {
      if (v < low) low = v;
      if (v > high) high = v;
    }
  }
  const double offset = low <= high ? low : 0, step = low < high ? (high - low) / most : 1;
  std::string bytes(2 * count, '\0');
  std::size_t at = 0;
  for (const auto& values : frames)
    for (const double v : values) {
      const auto q = std::isnan(v) ? 0U : static_cast<unsigned>(std::lround((v - offset) / step)) + 1U;
      bytes[at] = static_cast<char>(q >> 8U);
      bytes[count + at++] = static_cast<char>(q & 0xFFU);
    }
  return {{"offset", offset}, {"step", step}, {"bytes", base64(deflated(bytes, 9))}};
}

Json packed(const std::vector<double>& values) { return packed(std::vector<std::vector<double>>{values}); }

Json grid_json(const MapGrid& grid) {
  return {
      {"columns", grid.columns}, {"rows", grid.rows}, {"west", grid.west}, {"south", grid.south}, {"cell", grid.cell}};
}

Json ground_json(const Window& window, const Raster& elevation) {
  return {{"window", {{"west", window.west}, {"south", window.south}, {"east", window.east}, {"north", window.north}}},
          {"ground",
           {{"grid", grid_json(elevation.grid)},
            {"elevation", packed(elevation.values)},
            {"shade", packed(hillshade(elevation.grid, elevation.values))}}}};
}

Json line_json(const Polyline& line, const Window& window) {
  auto list = Json::array();
  for (const auto& [x, y] : line) {
    list.push_back(std::round(10 * (x - window.west)) / 10);
    list.push_back(std::round(10 * (y - window.south)) / 10);
  }
  return list;
}

Json lines_json(const std::vector<Polyline>& lines, const Window& window) {
  auto list = Json::array();
  for (const auto& line : lines) list.push_back(line_json(line, window));
  return list;
}

std::string base64(const std::string& bytes) {
  constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U; };
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const unsigned three = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    text += letters[three >> 18U];
    text += letters[three >> 12U & 63U];
    text += i + 1 < bytes.size() ? letters[three >> 6U & 63U] : '=';
    text += i + 2 < bytes.size() ? letters[three & 63U] : '=';
  }
  return text;
}

}  // namespace talus::postprocess
