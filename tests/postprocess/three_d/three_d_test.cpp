// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The folder 3d/: its files and meshes, and requests refused.
#include <zlib.h>
#include <cmath>
#include <cstring>
#include <regex>
#include <stdexcept>

#include "postprocess/three_d/three_d.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::holds;

/// Arrays of a VTK XML file as the format describes them (appended, raw, blocks of zlib), read without VTK.
class VtkReader {
 public:
  explicit VtkReader(const std::filesystem::path& file) : text_(test::text_of(file)) {
    const std::string mark = "<AppendedData encoding=\"raw\">\n_";
    data_ = text_.find(mark) + mark.size();
    EXPECT_GT(data_, mark.size());
    xml_ = text_.substr(0, data_);
  }
  const std::string& xml() const { return xml_; }

  /// The number of an attribute of the piece, such as NumberOfPoints.
  std::size_t count(const std::string& name) const {
    std::smatch found;
    return std::regex_search(xml_, found, std::regex(name + "=\"(\\d+)\"")) ? std::stoul(found[1]) : 0;
  }

  /// Values of the array called `name`, which must be of VTK's `type`.
  template <class T>
  std::vector<T> values(const std::string& name, const std::string& type) const {
    std::smatch found;
    const std::regex form("<DataArray type=\"" + type + "\" Name=\"" + name + "\"[^>]*offset=\"(\\d+)\"/>");
    if (!std::regex_search(xml_, found, form)) {
      ADD_FAILURE() << "no array " << name << " of type " << type;
      return {};
    }
    const std::string bytes = inflated(data_ + std::stoul(found[1]));
    std::vector<T> list(bytes.size() / sizeof(T));
    if (!list.empty()) std::memcpy(list.data(), bytes.data(), bytes.size());
    return list;
  }

 private:
  std::uint64_t number(std::size_t at) const {
    std::uint64_t value = 0;
    std::memcpy(&value, text_.data() + at, sizeof value);
    return value;
  }

  std::string inflated(std::size_t at) const {
    const std::uint64_t blocks = number(at), size = number(at + 8), last = number(at + 16);
    std::string bytes;
    std::size_t place = at + 24 + 8 * blocks;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::uint64_t packed = number(at + 24 + 8 * b);
      uLongf length = b + 1 == blocks && last > 0 ? last : size;
      std::string block(length, '\0');
      EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(block.data()), &length,
                           reinterpret_cast<const Bytef*>(text_.data() + place), packed),
                Z_OK);
      EXPECT_EQ(length, block.size());
      bytes += block;
      place += packed;
    }
    return bytes;
  }

  std::string text_, xml_;
  std::size_t data_ = 0;
};

VtkMesh square() {
  VtkMesh mesh;
  mesh.points = {{600000.1234567, 5100000, 1}, {600010, 5100000, 2}, {600010, 5100010, 3}, {600000, 5100010, 4}};
  mesh.quads = {{0, 1, 2, 3}};
  mesh.on_points = {{"thickness", std::vector<float>{0, 1, 2, 3}}};
  mesh.facts = {{"crs", "EPSG:32632 \"<&"}};
  return mesh;
}

using VtkFile = test::InScratch;

TEST_F(VtkFile, a_mesh_comes_back_with_its_cells_and_arrays_and_its_words_as_numbers) {
  write_vtp(scratch / "a.vtp", square());
  const VtkReader read(scratch / "a.vtp");
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
  EXPECT_TRUE(holds(VtkReader(scratch / "a.vtp").xml(), {"69 80 83 71 58 51 50 54 51 50 32 34 60 38 0<"}));
}

TEST_F(VtkFile, without_quadrilaterals_each_point_is_a_vertex_and_nothing_at_all_is_a_file_too) {
  VtkMesh mesh = square();
  mesh.quads.clear();
  write_vtp(scratch / "a.vtp", mesh);
  const VtkReader read(scratch / "a.vtp");
  EXPECT_EQ(read.count("NumberOfVerts"), 4U);
  EXPECT_EQ(read.count("NumberOfPolys"), 0U);
  EXPECT_EQ(read.values<std::int64_t>("offsets", "Int64"), (std::vector<std::int64_t>{1, 2, 3, 4}));
  write_vtp(scratch / "none.vtp", {});
  const VtkReader none(scratch / "none.vtp");
  EXPECT_EQ(none.count("NumberOfPoints"), 0U);
  EXPECT_TRUE(none.values<double>("Points", "Float64").empty());
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
  const VtkReader read(scratch / "a.vtp");
  EXPECT_EQ(read.values<std::int32_t>("id", "Int32"), ids);
  EXPECT_EQ(read.values<double>("Points", "Float64").size(), 450000U);
}

TEST_F(VtkFile, with_an_array_of_another_length_or_on_a_full_disk_is_not_written) {
  VtkMesh mesh = square();
  mesh.on_points.push_back({"short", std::vector<float>{1}});
  EXPECT_THROW(write_vtp(scratch / "a.vtp", mesh), std::logic_error);
  EXPECT_EQ(scratch.files(), 0U);
  const test::SmallFiles small(100);
  EXPECT_THROW(write_vtp(scratch / "a.vtp", square()), DataError);
  EXPECT_EQ(scratch.files(), 0U);
}

TEST_F(VtkFile, a_collection_names_a_file_for_each_time) {
  write_pvd(scratch / "a.pvd", {{0, 0, "surface/surface.0000.vtp"}, {2.5, 1, "a & b.vtp"}});
  EXPECT_TRUE(
      holds(test::text_of(scratch / "a.pvd"), {"<DataSet timestep=\"0\" part=\"0\" file=\"surface/surface.0000.vtp\"/>",
                                               "<DataSet timestep=\"2.5\" part=\"1\" file=\"a &amp; b.vtp\"/>"}));
}

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

TEST(SurfaceMesh, holds_the_volume_of_the_map_of_its_time_and_covers_the_flow_and_a_rim_of_one_cell) {
  const talus::Run run = test::small_run();
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const VtkMesh mesh = surface_mesh(run, frame, std::nullopt);
    EXPECT_NEAR(volume_below(mesh), 24000, 24000 * 1e-4);  // the bed is held in single precision
    EXPECT_EQ(array_of(mesh, "velocity"), nullptr);
  }
  const VtkMesh first = surface_mesh(test::small_run(), 0, std::nullopt);
  EXPECT_EQ(first.points.size(), 6U * 12U);  // 4 x 10 cells are released
  EXPECT_EQ(first.quads.size(), 5U * 11U);
  EXPECT_EQ(first.points.front()[0], 600025);
  EXPECT_EQ(first.points.front()[1], 5100095);
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

struct ThreeD : test::InScratch {
  ThreeD() { test::write_run(scratch / "run.h5", run_); }

  std::vector<std::string> written(const ThreeDParts& options) {
    std::vector<std::string> names;
    for (const auto& file : write_three_d(folder_, options, run_, PointFrames(scratch / "run.h5")))
      names.push_back(std::filesystem::relative(file, folder_).string());
    return names;
  }

  talus::Run run_ = test::small_run();
  const std::filesystem::path folder_ = scratch / "3d";
};

const ThreeDParts all_of_it{.points = true};

TEST_F(ThreeD, writes_what_is_asked_for_and_names_what_to_open_and_ground_and_surface_else) {
  EXPECT_EQ(written(all_of_it), (std::vector<std::string>{"terrain.vtp", "surface.pvd", "points.pvd", "run.pvd"}));
  EXPECT_EQ(test::names_in(folder_ / "surface"), (std::vector<std::string>{"surface.0000.vtp", "surface.0001.vtp"}));
  EXPECT_EQ(test::names_in(folder_ / "points"), (std::vector<std::string>{"points.0000.vtp"}));
  EXPECT_TRUE(
      holds(test::text_of(folder_ / "run.pvd"), {"timestep=\"20\" part=\"0\" file=\"terrain.vtp\"",
                                                 "timestep=\"20\" part=\"1\" file=\"surface/surface.0001.vtp\""}));
  EXPECT_EQ(written({}), (std::vector<std::string>{"terrain.vtp", "surface.pvd", "run.pvd"}));
  EXPECT_TRUE(written({.surface = false, .terrain = false}).empty());
}

TEST_F(ThreeD, says_its_size_beforehand_within_a_factor_of_four) {
  // The scene is tiny, so that heads of files count.
  talus::Run run = run_;
  for (int i = 0; i < 40; ++i) {
    run.frames.time.push_back(21 + i);
    run.frames.thickness.push_back(run.maps.deposit_thickness);
  }
  const PointFrames points(scratch / "run.h5");
  const ThreeDSize size = size_of_three_d({}, run, points);
  write_three_d(folder_, {}, run, points);
  double bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  EXPECT_LT(bytes / 1e6, 4 * size.all());
  EXPECT_GT(bytes / 1e6, size.all() / 4);
}

TEST_F(ThreeD, more_than_is_allowed_is_refused_with_its_parts_and_points_need_frames_of_points) {
  const std::string fault =
      test::fault_of<DataError>([&] { check_three_d(all_of_it, run_, PointFrames(scratch / "run.h5"), 0.01); });
  EXPECT_TRUE(holds(fault, {"3d/ will take about", "0.01 MB are allowed"}));
  RunWriter writer(scratch / "none.h5");
  writer.finish(run_.maps, {}, run_.summary);
  const PointFrames none(scratch / "none.h5");
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { check_three_d({.points = true}, run_, none); }), {"point_frames"}));
  check_three_d({}, run_, none);
}

}  // namespace
}  // namespace talus::postprocess
