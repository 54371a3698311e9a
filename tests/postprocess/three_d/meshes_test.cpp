// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of a run: where they lie, and the volume below them.
#include "postprocess/three_d/meshes.hpp"

#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

const VtkArray* array_of(const VtkMesh& mesh, const std::string& name) {
  for (const VtkArray& array : mesh.on_points)
    if (array.name == name) return &array;
  return nullptr;
}

std::vector<float> floats_of(const VtkMesh& mesh, const std::string& name) {
  const VtkArray* array = array_of(mesh, name);
  EXPECT_NE(array, nullptr) << name;
  return array != nullptr ? std::get<std::vector<float>>(array->values) : std::vector<float>{};
}

/// Between the bed and the surface, each quadrilateral cut along its diagonal from the south-west [m3].
double volume_below(const VtkMesh& mesh) {
  const auto bed = floats_of(mesh, "bed");
  double sum = 0;
  for (const auto& q : mesh.quads)
    for (const auto& triangle : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      double mean = 0, area = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto a = static_cast<std::size_t>(triangle[c]), b = static_cast<std::size_t>(triangle[(c + 1) % 3]);
        mean += (mesh.points[a][2] - static_cast<double>(bed[a])) / 3;
        area += 0.5 * (mesh.points[a][0] * mesh.points[b][1] - mesh.points[b][0] * mesh.points[a][1]);
      }
      EXPECT_GT(area, 0);  // anticlockwise from above
      sum += mean * area;
    }
  return sum;
}

TEST(SurfaceMesh, holds_the_volume_of_the_map_of_its_time) {
  const talus::Run run = test::small_run();
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const VtkMesh mesh = surface_mesh(run, frame, std::nullopt);
    EXPECT_NEAR(volume_below(mesh), 24000, 24000 * 1e-4);  // the bed is held in single precision
    EXPECT_EQ(array_of(mesh, "velocity"), nullptr);
  }
}

TEST(SurfaceMesh, covers_the_flow_and_a_rim_of_one_cell) {
  const VtkMesh mesh = surface_mesh(test::small_run(), 0, std::nullopt);
  EXPECT_EQ(mesh.points.size(), 6U * 12U);  // 4 x 10 cells are released
  EXPECT_EQ(mesh.quads.size(), 5U * 11U);
  EXPECT_EQ(mesh.points.front()[0], 600025);
  EXPECT_EQ(mesh.points.front()[1], 5100095);
}

TEST(SurfaceMesh, carries_the_mean_velocity_of_the_columns) {
  PointFrame points;
  points.position = {{600045, 5100145, 990}, {600045, 5100145, 995}};  // the centre of cell (4, 14)
  points.velocity = {{3, 0, -1}, {0, 6, 0}};
  points.volume = {1, 2};
  const auto of_cells = column_velocity(test::small_grid(), points);
  const std::size_t cell = test::small_grid().index(4, 14);
  EXPECT_FLOAT_EQ(of_cells[3 * cell], 1);
  EXPECT_FLOAT_EQ(of_cells[3 * cell + 1], 4);
  EXPECT_FLOAT_EQ(of_cells[3 * cell + 2], -1.0F / 3);
  EXPECT_EQ(of_cells[3 * (cell + 1)], 0);
  const VtkMesh mesh = surface_mesh(test::small_run(), 0, points);
  ASSERT_NE(array_of(mesh, "velocity"), nullptr);
  EXPECT_EQ(array_of(mesh, "velocity")->components, 3);
  float most = 0;
  for (const float v : floats_of(mesh, "velocity")) most = std::max(most, v);
  EXPECT_FLOAT_EQ(most, 4);
}

TEST(SurfaceMesh, stands_on_ground_that_can_be_taken_along_and_measures_what_flows) {
  talus::Run run = test::small_run();
  run.maps.eroded_depth.assign(run.maps.grid.count(), 0.0);
  for (auto& thickness : run.frames.thickness)
    for (double& h : thickness) h += 2;  // 2 m of it everywhere
  const VtkMesh mesh = surface_mesh(run, 0, std::nullopt);
  EXPECT_EQ(mesh.points.size(), 6U * 12U);
  const auto thickness = floats_of(mesh, "thickness"), bed = floats_of(mesh, "bed");
  for (std::size_t i = 0; i < thickness.size(); ++i)
    EXPECT_NEAR(mesh.points[i][2], static_cast<double>(bed[i] + thickness[i]) + 2, 1e-3);
}

TEST(TerrainMesh, leaves_out_what_lies_outside_the_domain) {
  const VtkMesh mesh = terrain_mesh(test::small_run().maps);
  EXPECT_EQ(mesh.points.size(), 40U * 28U);
  EXPECT_EQ(mesh.quads.size(), 39U * 27U);
  const auto deposit = floats_of(mesh, "deposit_thickness");
  double sum = 0;
  for (const float h : deposit) sum += static_cast<double>(h) * 100;
  EXPECT_NEAR(sum, 24000, 1e-3);
  EXPECT_NE(array_of(mesh, "arrival_time"), nullptr);
  EXPECT_EQ(array_of(mesh, "critical_thickness"), nullptr);
}

TEST(PointMesh, carries_what_the_run_holds_of_each_point) {
  PointFrame frame;
  frame.position = {{1, 2, 3}, {4, 5, 6}};
  frame.velocity = {{1, 2, 3}, {4, 5, 6}};
  frame.volume = {7, 8};
  frame.pressure = {9, 10};
  frame.id = {11, 12};
  frame.release = {0, 1};
  const VtkMesh mesh = point_mesh(frame);
  EXPECT_TRUE(mesh.quads.empty());
  EXPECT_EQ(mesh.points, frame.position);
  EXPECT_EQ(floats_of(mesh, "velocity"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(floats_of(mesh, "pressure"), frame.pressure);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(array_of(mesh, "id")->values), frame.id);
}

}  // namespace
}  // namespace talus::postprocess
