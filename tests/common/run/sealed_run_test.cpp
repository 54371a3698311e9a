// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// run.h5 as anybody can change it on purpose: any number replaced and the seal renewed.
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "common/run/hdf5.hpp"
#include "common/run/point_frames.hpp"
#include "common/stage/checksum.hpp"
#include "tests/postprocess/scene.hpp"

namespace fs = std::filesystem;

namespace talus {
namespace {

struct SealedRun : test::InScratch {
  const fs::path file_ = scratch / "run.h5";
};

/// A run that has some of everything.
Run whole_run() {
  Run run = test::small_run();
  run.maps.eroded_depth = run.maps.peak_thickness;
  run.maps.deposit_of = {{"a", run.maps.deposit_thickness}, {"b", run.maps.deposit_thickness}};
  run.history = test::small_history();
  run.summary.release_density = {2000, 1800};
  run.summary.profile = {{"scatter", 0.5}};
  return run;
}

/// The paths of all data sets of a file and the numbers among its attributes, these as "OBJECT NAME".
std::vector<std::string> numbers_in(const fs::path& file) {
  std::vector<std::string> paths;
  const h5::Id id(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const auto visit_object = [](hid_t root, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    auto& all = *static_cast<std::vector<std::string>*>(list);
    const std::string path = name[0] == '.' ? "/" : std::string("/") + name;
    if (info->type == H5O_TYPE_DATASET) all.push_back(path);
    const h5::Id object(H5Oopen(root, name, H5P_DEFAULT), H5Oclose);
    for (hsize_t n = 0; n < info->num_attrs; ++n) {
      const h5::Id attribute(H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, n, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
      const h5::Id type(H5Aget_type(attribute), H5Tclose);
      std::string attribute_name(100, ' ');
      attribute_name.resize(static_cast<std::size_t>(H5Aget_name(attribute, 100, attribute_name.data())));
      if (H5Tget_class(type) != H5T_STRING) all.push_back(fmt::format("{} {}", path, attribute_name));
    }
    return 0;
  };
  EXPECT_GE(H5Ovisit2(id, H5_INDEX_NAME, H5_ITER_INC, visit_object, &paths, H5O_INFO_BASIC | H5O_INFO_NUM_ATTRS), 0);
  return paths;
}

/// Writes `value` at the last place of a data set, or into an attribute, and renews the seal as anybody can.
void set_number(const fs::path& file, const std::string& path, double value) {
  {
    const h5::Id id(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    if (const auto space = path.find(' '); space != std::string::npos) {
      const std::string object = path.substr(0, space), name = path.substr(space + 1);
      const h5::Id was(H5Aopen_by_name(id, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      const h5::Id type(H5Aget_type(was), H5Tclose), extent(H5Aget_space(was), H5Sclose);
      ASSERT_GE(H5Adelete_by_name(id, object.c_str(), name.c_str(), H5P_DEFAULT), 0);
      const h5::Id is(
          H5Acreate_by_name(id, object.c_str(), name.c_str(), type, extent, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
          H5Aclose);
      ASSERT_GE(H5Awrite(is, H5T_NATIVE_DOUBLE, std::vector<double>(2, value).data()), 0);
    } else {
      const h5::Id set(H5Dopen2(id, path.c_str(), H5P_DEFAULT), H5Dclose);
      const h5::Id extent(H5Dget_space(set), H5Sclose);
      std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(extent)));
      ASSERT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
      values.back() = value;
      ASSERT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    }
  }
  seal_file(file, file);
}

/// Puts an empty data set in the place of one, and renews the seal.
void make_empty(const fs::path& file, const std::string& path) {
  {
    const h5::Id id(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const h5::Id was(H5Dopen2(id, path.c_str(), H5P_DEFAULT), H5Dclose);
    const h5::Id type(H5Dget_type(was), H5Tclose), extent(H5Dget_space(was), H5Sclose);
    std::vector<hsize_t> dims(static_cast<std::size_t>(H5Sget_simple_extent_ndims(extent)));
    H5Sget_simple_extent_dims(extent, dims.data(), nullptr);
    dims[0] = 0;
    const h5::Id none(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
    ASSERT_GE(H5Ldelete(id, path.c_str(), H5P_DEFAULT), 0);
    const h5::Id is(H5Dcreate2(id, path.c_str(), type, none, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  }
  seal_file(file, file);
}

/// What reading all of a run says of it, without the file's name.
std::string fault_of_all(const fs::path& file) {
  const std::string fault = test::fault_of<DataError>([&] {
    read_run(file);
    const PointFrames frames(file);
    for (std::size_t frame = 0; frame < frames.time().size(); ++frame) frames.read(frame);
  });
  return fault.empty() ? fault : fault.substr(file.string().size());
}

/// What ParaView alone reads, and texts and bytes as data sets.
bool is_no_number_of_ours(const std::string& path) {
  for (const char* other :
       {"/VTKHDF/Connectivity", "/VTKHDF/Offsets", "/VTKHDF/Types", "/VTKHDF/NumberOfC", "/VTKHDF/Version",
        "/VTKHDF Version", "/VTKHDF/Steps NSteps", "/VTKHDF/Steps/Cell", "/VTKHDF/Steps/Conn", "/VTKHDF/Steps/Part",
        "/VTKHDF/Steps/NumberOf", "/VTKHDF/Steps/PointData", "/places", "/findings", "/ format_version"})
    if (path.starts_with(other)) return true;
  return false;
}

TEST_F(SealedRun, refuses_every_number_of_it_that_cannot_be_though_its_seal_is_renewed) {
  test::write_run(file_, whole_run());
  ASSERT_EQ(fault_of_all(file_), "");
  const auto changed = scratch / "changed.h5";
  const auto fault_with = [&](const std::string& path, double value) {
    fs::copy_file(file_, changed, fs::copy_options::overwrite_existing);
    fs::resize_file(changed, fs::file_size(file_) - 128);
    set_number(changed, path, value);
    return fault_of_all(changed);
  };
  const std::set<std::string> signed_ones{"/maps west_m",
                                          "/maps south_m",
                                          "/maps/terrain",
                                          "/maps/before",
                                          "/VTKHDF/Points",
                                          "/VTKHDF/PointData/velocity",
                                          "/history/momentum_x_kg_m_s",
                                          "/ sanity_volume_error",
                                          "/VTKHDF/PointData/pressure"};
  std::size_t looked_at = 0;
  for (const std::string& path : numbers_in(file_)) {
    if (is_no_number_of_ours(path)) continue;
    ++looked_at;
    const bool whole = path == "/VTKHDF/PointData/id" || path == "/VTKHDF/PointData/release" || path == "/ particles" ||
                       path == "/ particles_outflow" || path == "/ steps" || path == "/maps columns" ||
                       path == "/maps rows";
    if (!whole) {
      EXPECT_TRUE(test::holds(fault_with(path, 1e30), {path.substr(0, path.find(' ')), "e+"})) << path;
    }
    if (!signed_ones.contains(path)) {
      EXPECT_TRUE(test::holds(fault_with(path, -5), {"-5"})) << path;
    }
  }
  EXPECT_GT(looked_at, 40U);
  for (const char* path : {"/maps west_m", "/maps south_m", "/maps cell_m", "/ density_kg_m3", "/ time_end_s",
                           "/release_density_kg_m3", "/history/time_s", "/history/kinetic_J", "/frames/time",
                           "/VTKHDF/Points", "/VTKHDF/PointData/velocity", "/VTKHDF/Steps/Values"})
    EXPECT_TRUE(test::holds(fault_with(path, std::nan("")), {"nan"})) << path;
  for (const char* path : {"/ density_kg_m3", "/release_density_kg_m3", "/maps cell_m"})
    EXPECT_NE(fault_with(path, 0), "") << path;
  for (const char* path : {"/history/time_s", "/frames/time"})
    EXPECT_TRUE(test::holds(fault_with(path, 0), {"holds 0 behind 0 (its values must grow)"})) << path;
  EXPECT_EQ(fault_with("/maps west_m", 1e300),
            ": attributes /maps cell_m, west_m and south_m are 10, 1e+300 and 5.1e+06 (no map has such cells there). "
            "Run talus-solve again");
  EXPECT_NE(fault_with("/maps cell_m", 1e-9), "") << "doubles tell such cells not apart";
  EXPECT_EQ(fault_with("/maps/peak_speed", 1e30),
            ": dataset /maps/peak_speed holds 1e+30 at place 1199 (0 to 100000 is possible, or NaN for none). Run "
            "talus-solve again");
}

TEST_F(SealedRun, refuses_every_data_set_of_it_that_is_empty) {
  test::write_run(file_, whole_run());
  const auto changed = scratch / "changed.h5";
  for (const std::string& path : numbers_in(file_)) {
    if (path.find(' ') != std::string::npos || path == "/release_density_kg_m3") continue;
    if (is_no_number_of_ours(path) && path != "/places" && path != "/findings") continue;
    fs::copy_file(file_, changed, fs::copy_options::overwrite_existing);
    fs::resize_file(changed, fs::file_size(file_) - 128);
    make_empty(changed, path);
    EXPECT_TRUE(test::holds(fault_of_all(changed), {"(", "Run talus-solve again"})) << path;
  }
}

TEST_F(SealedRun, refuses_maps_without_ground_and_places_beyond_any_map) {
  talus::Run run = whole_run();
  run.maps.terrain.assign(run.maps.terrain.size(), nan);
  test::write_run(file_, run);
  EXPECT_TRUE(test::begins(fault_of_all(file_), ": dataset /maps/terrain holds no number"));
  run = whole_run();
  run.summary.places = {{"gauge a", {{{1e300, 0}}}}};
  test::write_run(file_, run);
  EXPECT_TRUE(test::begins(fault_of_all(file_), ": dataset /places holds no places"));
}

}  // namespace
}  // namespace talus
