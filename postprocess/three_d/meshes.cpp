// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/three_d/meshes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/gis/crs.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/score/thalweg.hpp"

namespace talus::postprocess {
namespace {

/// Vertices at cell centres, and the cell that each is of.
struct CellMesh {
  VtkMesh mesh;
  std::vector<std::size_t> cells;
};

/// Quadrilaterals between the centres of four cells, where `shown` says so of their indices and all four have an
/// elevation.
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
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const std::array<std::size_t, 4> corners{grid.index(column, row), grid.index(column + 1, row),
                                               grid.index(column + 1, row + 1), grid.index(column, row + 1)};
      const bool ground =
          std::none_of(corners.begin(), corners.end(), [&](std::size_t i) { return std::isnan(elevation[i]); });
      if (!ground || !shown(corners)) continue;
      made.mesh.quads.push_back({vertex_of(column, row), vertex_of(column + 1, row), vertex_of(column + 1, row + 1),
                                 vertex_of(column, row + 1)});
    }
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

/// Calls add(cell, weight) for the four cells around the place, bilinear; the weights sum to 1, beyond the outermost
/// centres too.
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

}  // namespace talus::postprocess
