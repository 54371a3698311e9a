// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Reading run.h5: everything but the points.
#include <limits>
#include <string>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/run/check_values.hpp"
#include "common/run/grid_attributes.hpp"
#include "common/run/hdf5.hpp"
#include "common/run/history_group.hpp"
#include "common/run/run_facts.hpp"
#include "common/run/run_file.hpp"
#include "common/run/run_layout.hpp"

namespace talus {
namespace {

constexpr const char* mend = "Run talus-solve again";

h5::Dims shape_of(const MapGrid& grid) { return {static_cast<hsize_t>(grid.rows), static_cast<hsize_t>(grid.columns)}; }

/// One map, whose values are finite or none; of a quantity, such as a thickness, never negative.
std::vector<double> read_map(const h5::File& file, const std::string& path, const MapGrid& grid, bool elevation) {
  auto values = file.read<double>(path, shape_of(grid));
  h5::check_values<double>(file, path, values, elevation ? h5::finite_or_none : h5::not_negative_or_none);
  return values;
}

RunMaps read_maps(const h5::File& file) {
  RunMaps maps;
  maps.grid = h5::read_grid(file, "/maps");
  maps.threshold = h5::checked_number(file, "/maps", "threshold_m", h5::not_negative);
  for (const MapField& field : map_fields) {
    const auto path = std::string("/maps/") + field.name;
    const bool elevation = field.values == &RunMaps::terrain || field.values == &RunMaps::before;
    if (!field.optional || file.exists(path)) maps.*(field.values) = read_map(file, path, maps.grid, elevation);
  }
  if (file.exists("/maps/deposit_of")) {
    for (std::size_t r = 0; file.exists("/maps/deposit_of/" + std::to_string(r)); ++r) {
      const auto path = "/maps/deposit_of/" + std::to_string(r);
      maps.deposit_of.emplace_back(file.text(path, "release"), read_map(file, path, maps.grid, false));
    }
  }
  return maps;
}

RunFrames read_frames(const h5::File& file, const MapGrid& grid) {
  RunFrames frames;
  if (!file.exists("/frames/time")) return frames;
  frames.time = file.read_list<double>("/frames/time");
  h5::check_growing(file, "/frames/time", frames.time, true);
  auto shape = shape_of(grid);
  shape.insert(shape.begin(), frames.time.size());
  const auto all = file.read<double>("/frames/thickness", shape);
  h5::check_values<double>(file, "/frames/thickness", all, h5::not_negative_or_none);
  for (std::size_t i = 0; i < frames.time.size(); ++i) {
    const auto start = all.begin() + static_cast<std::ptrdiff_t>(i * grid.count());
    frames.thickness.emplace_back(start, start + static_cast<std::ptrdiff_t>(grid.count()));
  }
  return frames;
}

RunSummary read_summary(const h5::File& file) {
  RunSummary summary;
  for (const auto& item : run_layout::summary_texts) summary.*(item.value) = file.text("/", item.name);
  for (const auto& item : run_layout::summary_integers) {
    summary.*(item.value) = file.integer("/", item.name);
    if (summary.*(item.value) < 0)
      file.refuse(fmt::format("attribute / {} is {}", item.name, summary.*(item.value)), "a count is not negative");
  }
  for (const auto& item : run_layout::summary_numbers)
    summary.*(item.value) = h5::checked_number(file, "/", item.name, h5::not_negative);
  for (const SanityNumber& number : sanity_numbers) summary.sanity.*(number.value) = file.number("/", number.name);
  summary.sanity.words = file.text("/", run_layout::sanity_words);
  constexpr const char* density = run_layout::release_density;
  if (file.exists(density)) {
    summary.release_density = file.read_list<double>(density);
    h5::check_values<double>(file, density, summary.release_density, h5::not_negative);
  }
  for (const auto& phase : file.children("/profile")) {
    const auto seconds = file.read<double>("/profile/" + phase, {1});
    h5::check_values<double>(file, "/profile/" + phase, seconds, h5::not_negative);
    summary.profile.emplace_back(phase, seconds.front());
  }
  summary.provenance = run_facts(file);
  summary.findings = h5::read_findings(file);
  auto places = places_in(h5::read_text(file, "/places"));
  if (!places) file.refuse("dataset /places holds no places", "it was edited or written by another program");
  summary.places = std::move(*places);
  return summary;
}

}  // namespace

Run read_run(const std::filesystem::path& path) {
  const h5::File file = h5::open_sealed(path, {path, mend}, run_layout::format);
  Run run;
  run.maps = read_maps(file);
  run.frames = read_frames(file, run.maps.grid);
  run.history = read_history(file);
  run.summary = read_summary(file);
  return run;
}

}  // namespace talus
