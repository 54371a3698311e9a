// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// run.h5. Layout: attributes of / = summary; /VTKHDF = points (point_frames.hpp); /maps, /frames, /history, /profile,
// /provenance, /places, /findings.
#include "common/run/run_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/run/hdf5.hpp"
#include "common/run/point_frames.hpp"
#include "common/run/sealed_file.hpp"
#include "common/stage/checksum.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

constexpr h5::Format run_format{"talus-run", "a run of Talus"};

/// A member of RunSummary and the attribute that holds it.
template <class T>
struct SummaryItem {
  const char* name;
  T RunSummary::*value;
  h5::Allowed allowed = h5::not_negative;
};

constexpr SummaryItem<std::string> summary_texts[] = {
    {"scene", &RunSummary::scene},         {"title", &RunSummary::title},     {"on", &RunSummary::on},
    {"precision", &RunSummary::precision}, {"version", &RunSummary::version}, {"stop_reason", &RunSummary::stop_reason},
    {"material", &RunSummary::material},   {"bed", &RunSummary::bed},
};
/// The attribute for RunSanity::words.
constexpr const char* sanity_words = "sanity";
constexpr SummaryItem<std::int64_t> summary_integers[] = {{"particles", &RunSummary::particles},
                                                          {"particles_outflow", &RunSummary::particles_outflow},
                                                          {"steps", &RunSummary::steps}};
constexpr h5::Allowed a_density{.low = 1e-6, .high = limits::density};  // [kg/m3]
constexpr SummaryItem<double> summary_numbers[] = {
    {"time_end_s", &RunSummary::time_end, h5::a_time},
    {"layer_height_m", &RunSummary::layer_height, {.low = 0, .high = limits::cell}},
    {"wall_time_s", &RunSummary::wall_time, h5::a_time},
    {"memory_bytes", &RunSummary::memory},
    {"density_kg_m3", &RunSummary::density, a_density},
    {"volume_released_m3", &RunSummary::volume_released, h5::a_volume},
    {"volume_entrained_m3", &RunSummary::volume_entrained, h5::a_volume},
    {"volume_final_m3", &RunSummary::volume_final, h5::a_volume},
    {"volume_outflow_m3", &RunSummary::volume_outflow, h5::a_volume},
};

/// The list for RunSummary::release_density; only there where a run has releases.
constexpr const char* release_density = "/release_density_kg_m3";

constexpr const char* again = "Run talus-solve again";

void write_maps(h5::File& file, const RunMaps& maps) {
  file.make_group("/maps");
  h5::write_grid(file, "/maps", maps.grid);
  file.set_number("/maps", "threshold_m", maps.threshold);
  const auto write = [&](const std::string& path, const std::vector<double>& values, const char* unit,
                         const char* meaning) {
    file.write<double>(path, h5::shape_of(maps.grid), values);
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
  for (const auto& item : summary_texts) file.set_text("/", item.name, summary.*(item.value));
  for (const auto& item : summary_integers) file.set_integer("/", item.name, summary.*(item.value));
  for (const auto& item : summary_numbers) file.set_number("/", item.name, summary.*(item.value));
  for (const SanityNumber& number : sanity_numbers) file.set_number("/", number.name, summary.sanity.*(number.value));
  file.set_text("/", sanity_words, summary.sanity.words);
  if (!summary.release_density.empty()) file.write_list<double>(release_density, summary.release_density);
  file.make_group("/profile");
  for (const auto& [phase, seconds] : summary.profile) file.write_list<double>("/profile/" + phase, {&seconds, 1});
  h5::write_facts(file, "/provenance", summary.provenance);
  h5::write_text(file, "/places", places_json(summary.places));
  h5::write_findings(file, summary.findings);
}

/// What a number of a unit can be, of those of maps, histories and sanity; of a quantity, such as a thickness, never
/// negative.
h5::Allowed range_of(const std::string& unit, bool quantity) {
  h5::Allowed allowed{.none = unit != "J" && unit != "m3"};  // these two are of all that is there
  if (unit == "m") allowed.high = limits::height;
  if (unit == "s") allowed.high = limits::time;
  if (unit == "m s-1" || unit == "m/s") allowed.high = limits::speed;
  if (unit == "m3") allowed.high = limits::volume;
  if (unit == "kPa") allowed.high = limits::pressure / 1000;
  allowed.low = quantity ? 0 : -allowed.high;
  return allowed;
}

/// A map; the surfaces of a run tell which cells are in it, so that one of them without any is none.
std::vector<double> read_map(const h5::File& file, const MapField& field, const MapGrid& grid) {
  const auto path = std::string("/maps/") + field.name;
  const bool elevation = field.values == &RunMaps::terrain || field.values == &RunMaps::before;
  auto values = file.read<double>(path, h5::shape_of(grid), range_of(field.unit, !elevation));
  if (elevation && std::ranges::all_of(values, [](double z) { return std::isnan(z); }))
    file.refuse(fmt::format("dataset {} holds no number", path), "a run has ground under it");
  return values;
}

RunMaps read_maps(const h5::File& file) {
  RunMaps maps;
  maps.grid = h5::read_grid(file, "/maps");
  maps.threshold = h5::checked_number(file, "/maps", "threshold_m", h5::thickness);
  for (const MapField& field : map_fields) {
    if (!field.optional || file.exists(std::string("/maps/") + field.name))
      maps.*(field.values) = read_map(file, field, maps.grid);
  }
  for (std::size_t r = 0; file.exists("/maps/deposit_of/" + std::to_string(r)); ++r) {
    const auto path = "/maps/deposit_of/" + std::to_string(r);
    maps.deposit_of.emplace_back(file.text(path, "release"),
                                 file.read<double>(path, h5::shape_of(maps.grid), h5::thickness_or_none));
  }
  return maps;
}

RunFrames read_frames(const h5::File& file, const MapGrid& grid) {
  RunFrames frames;
  if (!file.exists(frame_times)) return frames;
  frames.time = file.read_list<double>(frame_times);
  h5::check_growing(file, frame_times, frames.time, h5::a_time);
  auto shape = h5::shape_of(grid);
  shape.insert(shape.begin(), frames.time.size());
  const auto all = file.read<double>(frame_thickness, shape, h5::thickness_or_none);
  for (std::size_t i = 0; i < frames.time.size(); ++i) {
    const auto start = all.begin() + static_cast<std::ptrdiff_t>(i * grid.count());
    frames.thickness.emplace_back(start, start + static_cast<std::ptrdiff_t>(grid.count()));
  }
  return frames;
}

RunSummary read_summary(const h5::File& file) {
  RunSummary summary;
  for (const auto& item : summary_texts) summary.*(item.value) = file.text("/", item.name);
  for (const auto& item : summary_integers) {
    summary.*(item.value) = file.integer("/", item.name);
    if (summary.*(item.value) < 0)
      file.refuse(fmt::format("attribute / {} is {}", item.name, summary.*(item.value)), "a count is not negative");
  }
  for (const auto& item : summary_numbers)
    summary.*(item.value) = h5::checked_number(file, "/", item.name, item.allowed);
  for (const SanityNumber& number : sanity_numbers) {
    const bool difference = number.value == &RunSanity::volume_error;
    summary.sanity.*(number.value) = h5::checked_number(file, "/", number.name, range_of(number.unit, !difference));
  }
  summary.sanity.words = file.text("/", sanity_words);
  if (file.exists(release_density)) summary.release_density = file.read_list<double>(release_density, a_density);
  for (const auto& phase : file.children("/profile"))
    summary.profile.emplace_back(phase, file.read<double>("/profile/" + phase, {1}, h5::a_time).front());
  summary.provenance = h5::read_facts(file, "/provenance");
  summary.findings = h5::read_findings(file);
  auto places = places_in(h5::read_text(file, "/places"));
  if (!places) file.refuse("dataset /places holds no places", "it was edited or written by another program");
  summary.places = std::move(*places);
  return summary;
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
    h5::set_format(file, run_format);
    file.make_group("/frames");
  }
  void close(const std::filesystem::path& name) {
    file.close();
    seal_file(pending.path(), name);
    pending.commit(name);
  }
};

RunWriter::RunWriter(std::filesystem::path file) : open_(std::make_unique<Open>(std::move(file))) {}
RunWriter::~RunWriter() = default;

void RunWriter::append(const PointFrame& frame) { open_->points.append(frame); }

void RunWriter::append_thickness(double time, const MapGrid& grid, const std::vector<double>& thickness) {
  if (!open_->frame_grid) open_->frame_grid = grid;
  if (open_->frame_grid->columns != grid.columns || open_->frame_grid->rows != grid.rows)
    throw std::logic_error("RunWriter: thickness frames on different grids");
  open_->file.append<double>(frame_times, 1, {}, std::span<const double>(&time, 1));
  open_->file.append<double>(frame_thickness, 1, h5::shape_of(grid), thickness);
}

void RunWriter::end_part(const std::filesystem::path& part, const std::string& id) {
  open_->points.finish();
  open_->file.set_text("/", run_mark, id);
  open_->close(part);
}

void RunWriter::finish(const RunMaps& maps, const RunHistory& history, const RunSummary& summary) {
  open_->points.finish();
  write_maps(open_->file, maps);
  write_history(open_->file, history);
  write_summary(open_->file, summary);
  open_->close(open_->pending.final_path());
}

Run read_run(const std::filesystem::path& path) {
  const h5::File file = h5::open_sealed(path, {path, again}, run_format);
  Run run;
  run.maps = read_maps(file);
  run.frames = read_frames(file, run.maps.grid);
  run.history = read_history(file);
  run.summary = read_summary(file);
  return run;
}

Facts run_facts(const std::filesystem::path& file) {
  return h5::read_facts(h5::open_sealed(file, {file, again}), "/provenance");
}

const HistoryColumn* RunHistory::find(const std::string& name) const {
  const auto found = std::ranges::find(columns, name, &HistoryColumn::name);
  return found == columns.end() ? nullptr : &*found;
}

const HistoryColumn& RunHistory::at(const std::string& name) const {
  if (const HistoryColumn* column = find(name)) return *column;
  throw std::logic_error("RunHistory: no column " + name);
}

HistoryColumn& RunHistory::at(const std::string& name) {
  return const_cast<HistoryColumn&>(std::as_const(*this).at(name));
}

void write_history(h5::File& file, const RunHistory& history) {
  file.make_group("/history");
  for (const HistoryColumn& column : history.columns) {
    if (column.values.size() != history.columns[0].values.size())
      throw std::logic_error("RunHistory: columns of different lengths");
    const auto path = "/history/" + column.name;
    file.write_list<double>(path, column.values);
    file.set_text(path, "unit", column.unit);
    if (!column.quantity.empty()) file.set_text(path, "quantity", column.quantity);
    if (!column.place.empty()) file.set_text(path, "place", column.place);
  }
}

namespace {

/// Whether a column of the history, of the run or of a place, is never negative.
bool counts(std::string_view name) {
  constexpr std::string_view all[] = {"step",        "step_size_s",   "kinetic_J",    "volume_m3",
                                      "outflow_m3",  "speed_max_m_s", "iterations",   "speed_max_so_far_m_s",
                                      "inflow_m3",   "step_cuts",     "speed_m_s",    "packing_p99",
                                      "packing_max", "step_over_cfl", "thickness_m",  "thickness_max_m",
                                      "area_m2",     "_points",       "points_apart", "largest_stretch"};
  return std::ranges::any_of(all, [&](std::string_view one) { return name.ends_with(one); });
}

}  // namespace

RunHistory read_history(const h5::File& file) {
  RunHistory history;
  for (const auto& name : file.children("/history")) {
    const auto path = "/history/" + name;
    const h5::Dims dims{history.columns.empty() ? file.length(path) : history.columns[0].values.size()};
    const auto word = [&](const char* attribute) {
      return file.has_attribute(path, attribute) ? file.text(path, attribute) : std::string();
    };
    std::vector<double> values = file.read<double>(path, dims);
    if (name == "time_s")
      h5::check_growing(file, path, values, h5::a_time);
    else
      h5::check_values<double>(file, path, values, range_of(word("unit"), counts(name)));
    history.columns.push_back({.name = name,
                               .unit = word("unit"),
                               .quantity = word("quantity"),
                               .place = word("place"),
                               .values = std::move(values)});
  }
  return history;
}

}  // namespace talus
