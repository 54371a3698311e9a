// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/report/pack.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/map/crop.hpp"

namespace talus::postprocess {
namespace {

constexpr double most = 65534;  // of 65536: 0 is NaN

std::string deflated(const std::string& bytes) {
  auto size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const auto status = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 9);
  if (status != Z_OK) throw std::runtime_error("zlib: " + std::string(zError(status)));
  packed.resize(size);
  return packed;
}

/// One number for several cells.
class Merged {
 public:
  explicit Merged(MergedCells merge) : merge_(merge) {}
  void add(double value) {
    if (std::isnan(value)) return;
    if (merge_ == MergedCells::mean) value_ = count_ == 0 ? value : value_ + value;
    if (merge_ == MergedCells::largest) value_ = count_ == 0 ? value : std::max(value_, value);
    if (merge_ == MergedCells::smallest) value_ = count_ == 0 ? value : std::min(value_, value);
    ++count_;
  }
  double value() const { return merge_ == MergedCells::mean && count_ > 0 ? value_ / count_ : value_; }

 private:
  MergedCells merge_;
  double value_ = nan;
  int count_ = 0;
};

}  // namespace

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
  for (int row = 0; row < coarse.grid.rows; ++row) {
    for (int column = 0; column < coarse.grid.columns; ++column) {
      Merged merged(merge);
      for (int r = row * factor; r < std::min((row + 1) * factor, grid.rows); ++r)
        for (int c = column * factor; c < std::min((column + 1) * factor, grid.columns); ++c)
          merged.add(raster.at(c, r));
      coarse.values.push_back(merged.value());
    }
  }
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

nlohmann::ordered_json packed(const std::vector<std::vector<double>>& frames) {
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
  for (const auto& values : frames) {
    for (const double v : values) {
      const auto q = std::isnan(v) ? 0U : static_cast<unsigned>(std::lround((v - offset) / step)) + 1U;
      bytes[at] = static_cast<char>(q >> 8U);
      bytes[count + at++] = static_cast<char>(q & 0xFFU);
    }
  }
  return {{"offset", offset}, {"step", step}, {"bytes", base64(deflated(bytes))}};
}

nlohmann::ordered_json packed(const std::vector<double>& values) {
  return packed(std::vector<std::vector<double>>{values});
}

nlohmann::ordered_json grid_json(const MapGrid& grid) {
  return {
      {"columns", grid.columns}, {"rows", grid.rows}, {"west", grid.west}, {"south", grid.south}, {"cell", grid.cell}};
}

nlohmann::ordered_json line_json(const Polyline& line, const Window& window) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& [x, y] : line) {
    list.push_back(std::round(10 * (x - window.west)) / 10);
    list.push_back(std::round(10 * (y - window.south)) / 10);
  }
  return list;
}

nlohmann::ordered_json lines_json(const std::vector<Polyline>& lines, const Window& window) {
  auto list = nlohmann::ordered_json::array();
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
