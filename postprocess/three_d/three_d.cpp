// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/three_d/three_d.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

/// Vertices at cell centres, and the cell that each is of.
struct CellMesh {
  VtkMesh mesh;
  std::vector<std::size_t> cells;
};

/// Quadrilaterals between the centres of four cells with elevations, where `shown` says so of their indices.
CellMesh mesh_of_cells(const MapGrid& grid, const std::vector<double>& elevation,
                       const std::function<bool(const std::array<std::size_t, 4>&)>& shown) {
  CellMesh made;
  std::vector<std::int64_t> vertex(grid.count(), -1);
  const auto vertex_of = [&](int column, int row) {
    const std::size_t cell = grid.index(column, row);
    if (vertex[cell] < 0) {
      vertex[cell] = static_cast<std::int64_t>(made.cells.size());
      made.cells.push_back(cell);
      made.mesh.points.push_back({grid.x(column), grid.y(row), elevation[cell]});
    }
    return vertex[cell];
  };
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const std::array<std::size_t, 4> corners{grid.index(column, row), grid.index(column + 1, row),
                                               grid.index(column + 1, row + 1), grid.index(column, row + 1)};
      const bool ground =
          std::none_of(corners.begin(), corners.end(), [&](std::size_t i) { return std::isnan(elevation[i]); });
      if (!ground || !shown(corners)) continue;
      made.mesh.quads.push_back({vertex_of(column, row), vertex_of(column + 1, row), vertex_of(column + 1, row + 1),
                                 vertex_of(column, row + 1)});
    }
  if (!grid.crs_wkt.empty()) made.mesh.facts.emplace_back("crs", crs_name(grid.crs_wkt));
  return made;
}

/// Values of the cells that the vertices are of.
std::vector<float> at_vertices(const CellMesh& made, const std::vector<double>& values) {
  std::vector<float> at;
  at.reserve(made.cells.size());
  for (const std::size_t cell : made.cells) at.push_back(static_cast<float>(values[cell]));
  return at;
}

/// Calls add(cell, weight) for the four cells around the place, bilinear; weights sum to 1, also at the grid's edge.
template <class Add>
void share_among_cells(const MapGrid& grid, double x, double y, const Add& add) {
  const double u = std::clamp((x - grid.west) / grid.cell - 0.5, 0.0, grid.columns - 1.0),
               v = std::clamp((y - grid.south) / grid.cell - 0.5, 0.0, grid.rows - 1.0);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const double fu = u - column, fv = v - row;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const double weight = (dx != 0 ? fu : 1 - fu) * (dy != 0 ? fv : 1 - fv);
    if (weight > 0) add(grid.index(column + dx, row + dy), weight);
  }
}

// Packed bytes, measured on the synthetic valley and Frank Slide: of a cell under the flow 36 and 31, of a cell of the
// ground 17 and 21, of a point 26 and 27.
constexpr double bytes_of_a_vertex = 34, bytes_of_ground = 20, bytes_of_a_point = 27;

/// Writes the files one after another and keeps what there is to open.
struct ThreeDFiles {
  const fs::path& folder;
  const ThreeDParts& options;
  const Run& run;
  const PointFrames& points;
  Progress progress{};
  std::vector<VtkPart> surfaces{}, of_points{};
  Files results{};

  Files write() {
    make_folder(folder);
    if (options.terrain) {
      write_vtp(folder / "terrain.vtp", terrain_mesh(run.maps));
      results.push_back(folder / "terrain.vtp");
    }
    if (options.surface) write_surfaces();
    if (options.points) write_points();
    write_scene();
    return std::move(results);
  }

  void write_surfaces() {
    make_folder(folder / "surface");
    for (std::size_t i = 0; i < run.frames.time.size(); ++i) {
      const double time = run.frames.time[i];
      step("surface", i, run.frames.time.size());
      std::optional<PointFrame> there;
      for (std::size_t k = 0; k < points.time().size() && !there; ++k)
        if (points.time()[k] == time && points.points(k) > 0) there = points.read(k);
      put("surface", i, time, surface_mesh(run, i, there));
    }
    collect("surface", surfaces);
  }

  void write_points() {
    make_folder(folder / "points");
    for (std::size_t i = 0; i < points.time().size(); ++i) {
      step("points", i, points.time().size());
      put("points", i, points.time()[i], point_mesh(points.read(i)));
    }
    collect("points", of_points);
  }

  void put(const std::string& what, std::size_t number, double time, const VtkMesh& mesh) {
    const std::string name = fmt::format("{}/{}.{:04}.vtp", what, what, number);
    write_vtp(folder / name, mesh);
    (what == "surface" ? surfaces : of_points).push_back({time, 0, name});
  }

  void collect(const std::string& what, const std::vector<VtkPart>& parts) {
    results.push_back(folder / (what + ".pvd"));
    write_pvd(results.back(), parts);
  }

  /// All of it at once: the ground as part 0 of each time, the flow's surface as part 1, its points as part 2.
  void write_scene() {
    std::vector<VtkPart> all;
    if (options.terrain)
      for (const VtkPart& part : surfaces.empty() ? of_points : surfaces) all.push_back({part.time, 0, "terrain.vtp"});
    for (const VtkPart& part : surfaces) all.push_back({part.time, 1, part.file});
    for (const VtkPart& part : of_points) all.push_back({part.time, 2, part.file});
    if (all.empty()) return;
    results.push_back(folder / "run.pvd");
    write_pvd(results.back(), all);
  }

  void step(const char* what, std::size_t number, std::size_t count) {
    stop_if_interrupted(std::string("writing 3d/") + what);
    if (progress.due()) progress.update(fmt::format("3d/{}  {}/{}", what, number + 1, count));
  }
};

double megabytes_under(const fs::path& folder) {
  double bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return bytes / 1e6;
}

ThreeDParts parts_of(const Job& job) {
  return {job.options.writes("surface"), job.options.writes("terrain"), job.options.writes("points")};
}

}  // namespace

VtkMesh terrain_mesh(const RunMaps& maps) {
  CellMesh made = mesh_of_cells(maps.grid, maps.terrain, [](const auto&) { return true; });
  for (const MapField& field : map_fields) {
    if (field.values == &RunMaps::terrain || (maps.*(field.values)).empty()) continue;
    made.mesh.on_points.push_back({field.name, at_vertices(made, maps.*(field.values))});
    made.mesh.facts.emplace_back(std::string("unit of ") + field.name, field.unit);
  }
  return std::move(made.mesh);
}

std::vector<float> column_velocity(const MapGrid& grid, const PointFrame& points) {
  std::vector<double> volume(grid.count(), 0.0), flux(3 * grid.count(), 0.0);
  for (std::size_t p = 0; p < points.position.size(); ++p) {
    share_among_cells(grid, points.position[p][0], points.position[p][1], [&](std::size_t cell, double weight) {
      const double part = weight * points.volume[p];
      volume[cell] += part;
      for (std::size_t a = 0; a < 3; ++a) flux[3 * cell + a] += part * points.velocity[p][a];
    });
  }
  std::vector<float> velocity(flux.size(), 0.0F);
  for (std::size_t i = 0; i < flux.size(); ++i)
    if (volume[i / 3] > 0) velocity[i] = static_cast<float>(flux[i] / volume[i / 3]);
  return velocity;
}

VtkMesh surface_mesh(const Run& run, std::size_t frame, const std::optional<PointFrame>& points) {
  const std::vector<double> flow = flow_thickness(run, frame);
  const std::vector<double>& all = run.frames.thickness.at(frame);  // with ground at rest that can be taken along
  std::vector<double> surface(run.maps.terrain);
  for (std::size_t i = 0; i < surface.size(); ++i) surface[i] += std::isnan(all[i]) ? 0 : all[i];
  CellMesh made = mesh_of_cells(run.maps.grid, surface, [&](const auto& corners) {
    return std::any_of(corners.begin(), corners.end(), [&](std::size_t i) { return flow[i] > thinnest_surface; });
  });
  auto thickness = at_vertices(made, flow);
  std::replace_if(
      thickness.begin(), thickness.end(), [](float h) { return std::isnan(h); }, 0.0F);
  made.mesh.on_points.push_back({"thickness", std::move(thickness)});
  made.mesh.on_points.push_back({"bed", at_vertices(made, run.maps.terrain)});
  if (points) {
    const std::vector<float> of_cells = column_velocity(run.maps.grid, *points);
    std::vector<float> velocity;
    for (const std::size_t cell : made.cells)
      for (std::size_t a = 0; a < 3; ++a) velocity.push_back(of_cells[3 * cell + a]);
    made.mesh.on_points.push_back({"velocity", std::move(velocity), 3});
  }
  return std::move(made.mesh);
}

VtkMesh point_mesh(const PointFrame& frame) {
  VtkMesh mesh;
  mesh.points = frame.position;
  std::vector<float> velocity;
  for (const auto& v : frame.velocity) velocity.insert(velocity.end(), v.begin(), v.end());
  mesh.on_points = {{"velocity", std::move(velocity), 3},
                    {"volume", frame.volume},
                    {"pressure", frame.pressure},
                    {"id", frame.id},
                    {"release", frame.release}};
  return mesh;
}

Writer vtk_writer() {
  const std::string number = "[0-9][0-9][0-9][0-9]*.";
  const std::vector<std::string> names{"3d/surface/surface." + number + "vtp",
                                       "3d/points/points." + number + "vtp",
                                       "3d/terrain.vtp",
                                       "3d/surface.pvd",
                                       "3d/points.pvd",
                                       "3d/run.pvd"};
  std::vector<std::string> outdated{"3d/volumes/flow." + number + "vdb",
                                    "3d/volumes/terrain.ply"};  // earlier versions'
  outdated.insert(outdated.end(), names.begin(), names.end());
  return {
      .name = "3d",
      .names = names,
      .write =
          [](const Job& job) { return write_three_d(job.out / "3d", parts_of(job), job.run, PointFrames(job.file)); },
      .words = {"surface", "terrain", "points"},
      .check = [](const Job& job) { check_three_d(parts_of(job), job.run, PointFrames(job.file)); },
      .outdated = std::move(outdated)};
}

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
                     "the run holds no points over time ([solve] point_frames = \"none\", or no frame interval)",
                     "Run talus-solve without point_frames, or leave this out"});
  const ThreeDSize size = size_of_three_d(options, run, points);
  const auto words = fmt::format("3d/ will take about {:.3g} MB (surface {:.3g}, terrain {:.3g}, points {:.3g})",
                                 size.all(), size.surface, size.terrain, size.points);
  if (size.all() > most)
    throw DataError({words, fmt::format("{:g} MB are allowed", most),
                     "Leave points out of outputs in [postprocess], or take a larger frame_interval_s"});
  log_detail(words);
}

Files write_three_d(const fs::path& folder, const ThreeDParts& options, const Run& run, const PointFrames& points) {
  if (!options.any()) return {};
  auto results = ThreeDFiles{folder, options, run, points}.write();
  log_detail(fmt::format("{}: {:.1f} MB", folder.string(), megabytes_under(folder)));
  return results;
}

}  // namespace talus::postprocess
