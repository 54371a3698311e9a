// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's XML files as their format describes them; `make check-three-d` opens them with ParaView.
#include "postprocess/three_d/vtk_file.hpp"

#include <cmath>
#include <stdexcept>

#include "tests/postprocess/three_d/vtk_reader.hpp"

namespace talus::postprocess {
namespace {

VtkMesh square() {
  VtkMesh mesh;
  mesh.points = {{600000.1234567, 5100000, 1}, {600010, 5100000, 2}, {600010, 5100010, 3}, {600000, 5100010, 4}};
  mesh.quads = {{0, 1, 2, 3}};
  mesh.on_points = {{"thickness", std::vector<float>{0, 1, 2, 3}}};
  mesh.facts = {{"crs", "EPSG:32632 \"<&"}};
  return mesh;
}

struct VtkFile : testing::Test {
  const test::Scratch scratch;
};

TEST_F(VtkFile, a_mesh_comes_back_with_its_cells_and_arrays) {
  write_vtp(scratch / "a.vtp", square());
  const test::VtkReader read(scratch / "a.vtp");
  EXPECT_EQ(read.count("NumberOfPoints"), 4U);
  EXPECT_EQ(read.count("NumberOfPolys"), 1U);
  EXPECT_EQ(read.count("NumberOfVerts"), 0U);
  EXPECT_EQ(read.values<std::int64_t>("connectivity", "Int64"), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(read.values<std::int64_t>("offsets", "Int64"), (std::vector<std::int64_t>{4}));
  EXPECT_EQ(read.values<float>("thickness", "Float32"), (std::vector<float>{0, 1, 2, 3}));
  const auto points = read.values<double>("Points", "Float64");
  ASSERT_EQ(points.size(), 12U);
  EXPECT_NEAR(points[0], 600000.1234567, 0.5 / 1024);  // rounded to 1/1024 m
  EXPECT_EQ(points[0] * 1024, std::round(points[0] * 1024));
  EXPECT_EQ(points[11], 4);
}

TEST_F(VtkFile, without_quadrilaterals_each_point_is_a_vertex) {
  VtkMesh mesh = square();
  mesh.quads.clear();
  write_vtp(scratch / "a.vtp", mesh);
  const test::VtkReader read(scratch / "a.vtp");
  EXPECT_EQ(read.count("NumberOfVerts"), 4U);
  EXPECT_EQ(read.count("NumberOfPolys"), 0U);
  EXPECT_EQ(read.values<std::int64_t>("offsets", "Int64"), (std::vector<std::int64_t>{1, 2, 3, 4}));
}

TEST_F(VtkFile, arrays_longer_than_a_block_come_back_whole) {
  VtkMesh mesh;
  std::vector<std::int32_t> ids;
  for (int i = 0; i < 150000; ++i) {
    mesh.points.push_back({1.0 * i, 0.5 * i, 7});
    ids.push_back(i);
  }
  mesh.on_points = {{"id", ids}};
  write_vtp(scratch / "a.vtp", mesh);
  const test::VtkReader read(scratch / "a.vtp");
  EXPECT_EQ(read.values<std::int32_t>("id", "Int32"), ids);
  EXPECT_EQ(read.values<double>("Points", "Float64").size(), 450000U);
}

TEST_F(VtkFile, nothing_at_all_is_a_file_too) {
  write_vtp(scratch / "a.vtp", {});
  const test::VtkReader read(scratch / "a.vtp");
  EXPECT_EQ(read.count("NumberOfPoints"), 0U);
  EXPECT_TRUE(read.values<double>("Points", "Float64").empty());
}

TEST_F(VtkFile, words_are_numbers_so_that_none_can_end_the_xml) {
  write_vtp(scratch / "a.vtp", square());
  EXPECT_TRUE(test::holds(test::VtkReader(scratch / "a.vtp").xml(), {"69 80 83 71 58 51 50 54 51 50 32 34 60 38 0<"}));
}

TEST_F(VtkFile, an_array_of_another_length_is_a_bug) {
  VtkMesh mesh = square();
  mesh.on_points.push_back({"short", std::vector<float>{1}});
  EXPECT_THROW(write_vtp(scratch / "a.vtp", mesh), std::logic_error);
  EXPECT_EQ(scratch.files(), 0U);
}

TEST_F(VtkFile, a_full_disk_leaves_nothing_behind) {
  const test::SmallFiles small(100);
  EXPECT_THROW(write_vtp(scratch / "a.vtp", square()), DataError);
  EXPECT_EQ(scratch.files(), 0U);
}

TEST_F(VtkFile, a_collection_names_a_file_for_each_time) {
  write_pvd(scratch / "a.pvd", {{0, 0, "surface/surface.0000.vtp"}, {2.5, 1, "a & b.vtp"}});
  const std::string text = test::text_of(scratch / "a.pvd");
  EXPECT_TRUE(test::holds(text, {"<DataSet timestep=\"0\" part=\"0\" file=\"surface/surface.0000.vtp\"/>",
                                 "<DataSet timestep=\"2.5\" part=\"1\" file=\"a &amp; b.vtp\"/>"}));
}

}  // namespace
}  // namespace talus::postprocess
