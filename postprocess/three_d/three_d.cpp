// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/three_d/three_d.hpp"

#include <chrono>
#include <optional>

#include <fmt/format.h>

#include "common/stage/stage.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/three_d/meshes.hpp"
#include "postprocess/three_d/vtk_file.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

// Packed bytes, measured on the synthetic valley and Frank Slide: of a cell under the flow 36 and 31, of a cell of the
// ground 17 and 21, of a point 26 and 27.
constexpr double bytes_of_a_vertex = 34, bytes_of_ground = 20, bytes_of_a_point = 27;

/// The frame of points of the time of a frame of thickness; none where there is none.
std::optional<std::size_t> frame_of_points(const PointFrames& points, double time) {
  for (std::size_t i = 0; i < points.time().size(); ++i)
    if (points.time()[i] == time && points.points(i) > 0) return i;
  return std::nullopt;
}

/// Writes the files one after another and keeps what there is to open.
class ThreeDFiles {
 public:
  ThreeDFiles(const fs::path& folder, const ThreeDParts& options, const Run& run, const PointFrames& points)
      : folder_(folder), options_(options), run_(run), points_(points) {}

  Files write() {
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
  const ThreeDParts& options_;
  const Run& run_;
  const PointFrames& points_;
  Progress progress_;
  std::vector<VtkPart> surfaces_, of_points_;
  Files results_;
};

double megabytes_under(const fs::path& folder) {
  double bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return bytes / 1e6;
}

class VtkWriter : public Writer {
 public:
  std::string name() const override { return "3d"; }
  std::vector<std::string_view> words() const override { return {"surface", "terrain", "points"}; }
  bool wanted(const Job& job) const override { return parts_of(job).any(); }
  void check(const Job& job) const override { check_three_d(parts_of(job), job.run, PointFrames(job.file)); }
  std::vector<std::string> names() const override {
    const std::string number = "[0-9][0-9][0-9][0-9]*.vtp";
    return {"3d/surface/surface." + number,
            "3d/points/points." + number,
            "3d/terrain.vtp",
            "3d/surface.pvd",
            "3d/points.pvd",
            "3d/run.pvd"};
  }
  /// With the volumes that earlier versions wrote.
  std::vector<std::string> outdated() const override {
    std::vector<std::string> files{"3d/volumes/flow.[0-9][0-9][0-9][0-9]*.vdb", "3d/volumes/terrain.ply"};
    for (std::string& name : names()) files.push_back(std::move(name));
    return files;
  }
  Files write(const Job& job) const override {
    return write_three_d(job.out / "3d", parts_of(job), job.run, PointFrames(job.file));
  }

 private:
  static ThreeDParts parts_of(const Job& job) {
    return {job.options.writes("surface"), job.options.writes("terrain"), job.options.writes("points")};
  }
};

}  // namespace

std::shared_ptr<Writer> vtk_writer() { return std::make_shared<VtkWriter>(); }

ThreeDSize size_of_three_d(const ThreeDParts& options, const Run& run, const PointFrames& points) {
  ThreeDSize size;
  if (options.surface)
    for (std::size_t i = 0; i < run.frames.time.size(); ++i)
      for (const double h : flow_thickness(run, i)) size.surface += h > thinnest_surface ? bytes_of_a_vertex / 1e6 : 0;
  if (options.terrain) size.terrain = bytes_of_ground * static_cast<double>(run.maps.grid.count()) / 1e6;
  if (options.points) size.points = bytes_of_a_point * static_cast<double>(points.all_points()) / 1e6;
  return size;
}

void check_three_d(const ThreeDParts& options, const Run& run, const PointFrames& points, double most) {
  if (options.points && points.most_points() == 0)
    throw DataError({"[postprocess] outputs has \"points\"",
                     "the run holds no points over time ([solve] point_frames = false, or no frame interval)",
                     "Run talus-solve with point_frames = true, or leave this out"});
  const ThreeDSize size = size_of_three_d(options, run, points);
  const auto words = fmt::format("3d/ will take about {:.3g} MB (surface {:.3g}, terrain {:.3g}, points {:.3g})",
                                 size.all(), size.surface, size.terrain, size.points);
  if (size.all() > most)
    throw DataError({words, fmt::format("{:g} MB are allowed", most),
                     "Leave points out of outputs in [postprocess], or take a larger frame_interval_s"});
  log_info(words);
}

Files write_three_d(const fs::path& folder, const ThreeDParts& options, const Run& run, const PointFrames& points) {
  if (!options.any()) return {};
  const auto begun = std::chrono::steady_clock::now();
  auto results = ThreeDFiles(folder, options, run, points).write();
  log_info(fmt::format("{}: {:.1f} MB in {:.1f} s", folder.string(), megabytes_under(folder),
                       std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count()));
  return results;
}

}  // namespace talus::postprocess
