// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Writing run.h5. Layout: attributes of / = summary; /VTKHDF = points (vtkhdf.hpp); /maps, /frames, /history,
// /profile, /provenance, /places, /findings.
#include "common/run/run_file.hpp"

#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "common/run/grid_attributes.hpp"
#include "common/run/hdf5.hpp"
#include "common/run/history_group.hpp"
#include "common/run/run_layout.hpp"
#include "common/run/vtkhdf.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

void write_maps(h5::File& file, const RunMaps& maps) {
  file.make_group("/maps");
  h5::write_grid(file, "/maps", maps.grid);
  file.set_number("/maps", "threshold_m", maps.threshold);
  const h5::Dims shape{static_cast<hsize_t>(maps.grid.rows), static_cast<hsize_t>(maps.grid.columns)};
  const auto write = [&](const std::string& path, const std::vector<double>& values, const char* unit,
                         const char* meaning) {
    file.write<double>(path, shape, values);
    file.set_text(path, "unit", unit);
    file.set_text(path, "long_name", meaning);
  };
  for (const MapField& field : map_fields) {
    const std::vector<double>& values = maps.*(field.values);
    if (!(field.optional && values.empty()))
      write(std::string("/maps/") + field.name, values, field.unit, field.meaning);
  }
  if (maps.deposit_of.empty()) return;
  file.make_group("/maps/deposit_of");
  for (std::size_t r = 0; r < maps.deposit_of.size(); ++r) {
    const auto path = "/maps/deposit_of/" + std::to_string(r);
    write(path, maps.deposit_of[r].second, "m", "thickness at the end of what came from one release, vertical");
    file.set_text(path, "release", maps.deposit_of[r].first);
  }
}

void write_summary(h5::File& file, const RunSummary& summary) {
  for (const auto& item : run_layout::summary_texts) file.set_text("/", item.name, summary.*(item.value));
  for (const auto& item : run_layout::summary_integers) file.set_integer("/", item.name, summary.*(item.value));
  for (const auto& item : run_layout::summary_numbers) file.set_number("/", item.name, summary.*(item.value));
  for (const SanityNumber& number : sanity_numbers) file.set_number("/", number.name, summary.sanity.*(number.value));
  file.set_text("/", run_layout::sanity_words, summary.sanity.words);
  if (!summary.release_density.empty())
    file.write<double>(run_layout::release_density, {summary.release_density.size()}, summary.release_density);
  file.make_group("/profile");
  for (const auto& [phase, seconds] : summary.profile) {
    file.write<double>("/profile/" + phase, {1}, std::vector<double>{seconds});
  }
  h5::write_facts(file, "/provenance", summary.provenance);
  h5::write_text(file, "/places", places_json(summary.places));
  h5::write_findings(file, summary.findings);
}

}  // namespace

/// The order matters: the file is closed before the pending name is removed.
struct RunWriter::Open {
  PendingFile pending;
  h5::File file;
  VtkHdfPoints points;
  std::optional<MapGrid> frame_grid;

  explicit Open(std::filesystem::path path)
      : pending(std::move(path)), file(h5::File::create(pending.path(), {pending.final_path(), ""})), points(file) {
    h5::set_format(file, run_layout::format);
    file.make_group("/frames");
  }
};

RunWriter::RunWriter(std::filesystem::path file) : open_(std::make_unique<Open>(std::move(file))) {}
RunWriter::~RunWriter() = default;

void RunWriter::append(const PointFrame& frame) { open_->points.append(frame); }

void RunWriter::append_thickness(double time, const MapGrid& grid, const std::vector<double>& thickness) {
  if (!open_->frame_grid) open_->frame_grid = grid;
  if (open_->frame_grid->columns != grid.columns || open_->frame_grid->rows != grid.rows) {
    throw std::logic_error("RunWriter: thickness frames on different grids");
  }
  const h5::Dims shape{static_cast<hsize_t>(grid.rows), static_cast<hsize_t>(grid.columns)};
  open_->file.append<double>("/frames/time", 1, {}, std::span<const double>(&time, 1));
  open_->file.append<double>("/frames/thickness", 1, shape, thickness);
}

void RunWriter::finish(const RunMaps& maps, const RunHistory& history, const RunSummary& summary) {
  open_->points.finish();
  write_maps(open_->file, maps);
  write_history(open_->file, history);
  write_summary(open_->file, summary);
  open_->file.close();
  seal_file(open_->pending.path(), open_->pending.final_path());
  open_->pending.commit();
}

}  // namespace talus
