// Reading run.h5: everything but the points.
#include <limits>
#include <string>

#include "common/error.hpp"
#include "common/run/hdf5.hpp"
#include "common/run/history_group.hpp"
#include "common/run/run_file.hpp"
#include "common/run/run_layout.hpp"

namespace talus {
namespace {

constexpr const char* mend = "Run talus-solve again";

void check_format(const h5::File& file, const std::filesystem::path& path) {
  if (!file.has_attribute("/", "format") || file.text("/", "format") != run_layout::format) {
    throw DataError({path.string() + ": not a run of Talus", "an HDF5 file without the mark talus-solve leaves",
                     "Give the run.h5 that talus-solve wrote"});
  }
  const auto version = file.integer("/", "format_version");
  if (version != run_layout::format_version) {
    throw DataError({path.string() + ": layout version " + std::to_string(version),
                     "this program reads version " + std::to_string(run_layout::format_version), mend});
  }
}

MapGrid read_grid(const h5::File& file) {
  const auto columns = file.integer("/maps", "columns"), rows = file.integer("/maps", "rows");
  constexpr auto limit = std::numeric_limits<int>::max();
  MapGrid grid{.columns = static_cast<int>(columns),
               .rows = static_cast<int>(rows),
               .west = file.number("/maps", "west_m"),
               .south = file.number("/maps", "south_m"),
               .cell = file.number("/maps", "cell_m"),
               .crs_wkt = file.text("/maps", "crs_wkt")};
  if (columns < 1 || rows < 1 || columns > limit || rows > limit || !(grid.cell > 0))
    file.fail("holds an impossible map grid");
  return grid;
}

h5::Dims shape_of(const MapGrid& grid) { return {static_cast<hsize_t>(grid.rows), static_cast<hsize_t>(grid.columns)}; }

RunMaps read_maps(const h5::File& file) {
  RunMaps maps;
  maps.grid = read_grid(file);
  maps.threshold = file.number("/maps", "threshold_m");
  for (const MapField& field : map_fields) {
    const auto path = std::string("/maps/") + field.name;
    if (!field.optional || file.exists(path)) maps.*(field.values) = file.read<double>(path, shape_of(maps.grid));
  }
  if (file.exists("/maps/deposit_of")) {
    for (std::size_t r = 0; file.exists("/maps/deposit_of/" + std::to_string(r)); ++r) {
      const auto path = "/maps/deposit_of/" + std::to_string(r);
      maps.deposit_of.emplace_back(file.text(path, "release"), file.read<double>(path, shape_of(maps.grid)));
    }
  }
  return maps;
}

RunFrames read_frames(const h5::File& file, const MapGrid& grid) {
  RunFrames frames;
  if (!file.exists("/frames/time")) return frames;
  frames.time = file.read<double>("/frames/time", file.dims("/frames/time"));
  auto shape = shape_of(grid);
  shape.insert(shape.begin(), frames.time.size());
  const auto all = file.read<double>("/frames/thickness", shape);
  for (std::size_t i = 0; i < frames.time.size(); ++i) {
    const auto start = all.begin() + static_cast<std::ptrdiff_t>(i * grid.count());
    frames.thickness.emplace_back(start, start + static_cast<std::ptrdiff_t>(grid.count()));
  }
  return frames;
}

RunSummary read_summary(const h5::File& file) {
  RunSummary summary;
  for (const auto& item : run_layout::summary_texts) summary.*(item.value) = file.text("/", item.name);
  for (const auto& item : run_layout::summary_laws) {
    if (file.has_attribute("/", item.name)) summary.*(item.value) = file.text("/", item.name);
  }
  for (const auto& item : run_layout::summary_integers) summary.*(item.value) = file.integer("/", item.name);
  for (const auto& item : run_layout::summary_numbers) summary.*(item.value) = file.number("/", item.name);
  for (const SanityNumber& number : sanity_numbers) {
    if (file.has_attribute("/", number.name)) summary.sanity.*(number.value) = file.number("/", number.name);
  }
  constexpr const char* words = run_layout::sanity_words;
  if (file.has_attribute("/", words)) summary.sanity.words = file.text("/", words);
  for (const auto& phase : file.children("/profile")) {
    summary.profile.emplace_back(phase, file.read<double>("/profile/" + phase, {1}).front());
  }
  for (const auto& name : file.children("/provenance")) {
    const auto group = "/provenance/" + name;
    summary.provenance.emplace_back(file.text(group, "key"), file.text(group, "value"));
  }
  return summary;
}

}  // namespace

Run read_run(const std::filesystem::path& path) {
  const auto file = h5::File::open(path, {path, mend});
  check_format(file, path);
  Run run;
  run.maps = read_maps(file);
  run.frames = read_frames(file, run.maps.grid);
  run.history = read_history(file);
  run.summary = read_summary(file);
  return run;
}

}  // namespace talus
