// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/three_d/three_d.hpp"

#include <chrono>
#include <optional>
#include <regex>
#include <system_error>

#include <fmt/format.h>

#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/three_d/meshes.hpp"
#include "postprocess/three_d/vtk_file.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

/// The frame of points of the time of a frame of thickness; none where there is none.
std::optional<std::size_t> frame_of_points(const PointFrames& points, double time) {
  for (std::size_t i = 0; i < points.time().size(); ++i)
    if (points.time()[i] == time && points.points(i) > 0) return i;
  return std::nullopt;
}

/// Writes the files one after another and keeps what there is to open.
class ThreeDWriter {
 public:
  ThreeDWriter(const fs::path& folder, const ThreeDOptions& options, const Run& run, const PointFrames& points)
      : folder_(folder), options_(options), run_(run), points_(points) {}

  std::vector<fs::path> write() {
    make_folder(folder_);
    if (options_.terrain) {
      write_vtp(folder_ / "terrain.vtp", terrain_mesh(run_.maps));
      results_.push_back(folder_ / "terrain.vtp");
    }
    if (options_.surface) write_surfaces();
    if (options_.points) write_points();
    write_scene();
    return std::move(results_);
  }

 private:
  void write_surfaces() {
    make_folder(folder_ / "surface");
    for (std::size_t i = 0; i < run_.frames.time.size(); ++i) {
      const double time = run_.frames.time[i];
      step("surface", i, run_.frames.time.size());
      std::optional<PointFrame> points;
      if (const auto frame = frame_of_points(points_, time)) points = points_.read(*frame);
      put("surface", i, time, surface_mesh(run_, i, points));
    }
    collect("surface", surfaces_);
  }

  void write_points() {
    make_folder(folder_ / "points");
    for (std::size_t i = 0; i < points_.time().size(); ++i) {
      step("points", i, points_.time().size());
      put("points", i, points_.time()[i], point_mesh(points_.read(i)));
    }
    collect("points", of_points_);
  }

  void put(const std::string& what, std::size_t number, double time, const VtkMesh& mesh) {
    const std::string name = fmt::format("{}/{}.{:04}.vtp", what, what, number);
    write_vtp(folder_ / name, mesh);
    (what == "surface" ? surfaces_ : of_points_).push_back({time, 0, name});
  }

  void collect(const std::string& what, const std::vector<VtkPart>& parts) {
    results_.push_back(folder_ / (what + ".pvd"));
    write_pvd(results_.back(), parts);
  }

  /// All of it at once: the ground as part 0 of each time, the flow's surface as part 1, its points as part 2.
  void write_scene() {
    std::vector<VtkPart> all;
    if (options_.terrain)
      for (const VtkPart& part : surfaces_.empty() ? of_points_ : surfaces_)
        all.push_back({part.time, 0, "terrain.vtp"});
    for (const VtkPart& part : surfaces_) all.push_back({part.time, 1, part.file});
    for (const VtkPart& part : of_points_) all.push_back({part.time, 2, part.file});
    if (all.empty()) return;
    results_.push_back(folder_ / "run.pvd");
    write_pvd(results_.back(), all);
  }

  void step(const char* what, std::size_t number, std::size_t count) {
    stop_if_interrupted(std::string("writing 3d/") + what);
    if (progress_.due()) progress_.update(fmt::format("3d/{}  {}/{}", what, number + 1, count));
  }

  const fs::path& folder_;
  const ThreeDOptions& options_;
  const Run& run_;
  const PointFrames& points_;
  Progress progress_;
  std::vector<VtkPart> surfaces_, of_points_;
  std::vector<fs::path> results_;
};

double megabytes_under(const fs::path& folder) {
  double bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return bytes / 1e6;
}

}  // namespace

void remove_three_d(const fs::path& folder) {
  static const std::regex ours(
      R"((surface|points|flow)\.\d{4,}\.(vtp|vdb)|(run|surface|points)\.pvd|terrain\.(vtp|ply))");
  std::error_code none_there;
  std::vector<fs::path> old;
  for (const fs::path& part : {folder, folder / "surface", folder / "points", folder / "volumes"})
    for (const auto& entry : fs::directory_iterator(part, none_there))
      if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), ours))
        old.push_back(entry.path());
  for (const fs::path& file : old) fs::remove(file, none_there);
  for (const fs::path& part : {folder / "surface", folder / "points", folder / "volumes", folder})
    fs::remove(part, none_there);  // only where nothing is left in it
}

std::vector<fs::path> write_three_d(const fs::path& folder, const ThreeDOptions& options, const Run& run,
                                    const PointFrames& points) {
  if (!options.writes()) return {};
  const auto begun = std::chrono::steady_clock::now();
  auto results = ThreeDWriter(folder, options, run, points).write();
  log_info(fmt::format("{}: {:.1f} MB in {:.1f} s", folder.string(), megabytes_under(folder),
                       std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count()));
  return results;
}

}  // namespace talus::postprocess
