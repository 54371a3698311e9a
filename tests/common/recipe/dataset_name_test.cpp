// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/dataset_name.hpp"

#include "tests/common/scratch.hpp"

namespace talus {
namespace {

struct dataset_names : test::InScratch {
  /// The name as it is from the folder, with $ for the folder.
  std::string from_folder(const std::string& text) const {
    const auto name = dataset_name(text, scratch.folder());
    return name ? scratch.from_here(name->from(scratch.folder()), "$/") : "none";
  }
};

TEST_F(dataset_names, count_relative_paths_from_the_folder_and_keep_absolute_ones) {
  const std::pair<const char*, const char*> names[] = {
      {"NETCDF:\"dem.nc\":z", "NETCDF:\"$/dem.nc\":z"},
      {"netcdf:\"dem.nc\":z", "netcdf:\"$/dem.nc\":z"},
      {"NETCDF:dem.nc:z", "NETCDF:$/dem.nc:z"},
      {"NETCDF:\"/a/dem.nc\":z", "NETCDF:\"/a/dem.nc\":z"},
      {"NETCDF:\"../a b/dem.nc\":z", "NETCDF:\"$/../a b/dem.nc\":z"},
      {"HDF5:\"f.h5\"://group/z", "HDF5:\"$/f.h5\"://group/z"},
      {"HDF5:f.h5://group/z", "HDF5:$/f.h5://group/z"},
      {"GPKG:sub/a.gpkg:dem", "GPKG:$/sub/a.gpkg:dem"},
      {"GTIFF_DIR:2:a.tif", "GTIFF_DIR:2:$/a.tif"},
      {"NITF_IM:0:a.ntf", "NITF_IM:0:$/a.ntf"},
      {"/vsizip/dem.zip/dem.tif", "/vsizip/$/dem.zip/dem.tif"},
      {"/vsizip//a/dem.zip/dem.tif", "/vsizip//a/dem.zip/dem.tif"},
      {"/vsitar/dem.tar.gz/x/dem.tif", "/vsitar/$/dem.tar.gz/x/dem.tif"},
      {"/vsigzip/dem.asc.gz", "/vsigzip/$/dem.asc.gz"},
      {"/vsizip/{dem.zip}/dem.tif", "/vsizip/{$/dem.zip}/dem.tif"},
      {"/vsizip//vsigzip/dem.zip.gz/dem.tif", "/vsizip//vsigzip/$/dem.zip.gz/dem.tif"},
      {"/vsizip/vsigzip/dem.zip.gz/dem.tif", "/vsizip//vsigzip/$/dem.zip.gz/dem.tif"},
      {"/vsisubfile/100_200,dem.bin", "/vsisubfile/100_200,$/dem.bin"},
      {"NETCDF:\"/vsizip/dem.zip/dem.nc\":z", "NETCDF:\"/vsizip/$/dem.zip/dem.nc\":z"},
  };
  for (const auto& [text, expected] : names) {
    std::string there = expected;
    const auto dots = there.find("$/../");
    if (dots != std::string::npos) there.replace(dots, 5, scratch.folder().parent_path().string() + "/");
    EXPECT_EQ(from_folder(text), there);
  }
}

TEST_F(dataset_names, are_none_of_plain_paths_and_networks) {
  for (const char* text : {"dem.tif", "/a/b/dem.tif", "C.tif", "a:b.tif", "", "/vsicurl/https://x.org/a.tif",
                           "/vsizip//vsicurl/https://x.org/a.zip/a.tif", "/vsizip/vsis3/b/a.zip/a.tif",
                           "https://x.org/a.tif", "PG:dbname=x", "WMS:http://x.org/?LAYERS=a", "PG:\"dbname=x://\"",
                           "NETCDF:\"https://x.org/a.nc\":z", "/vsis3/bucket/a.tif", "/vsistdin/"})
    EXPECT_EQ(from_folder(text), "none") << text;
}

TEST_F(dataset_names, take_the_word_that_is_a_file) {
  scratch.write("dem.tif", "x");
  EXPECT_EQ(from_folder("DERIVED_SUBDATASET:LOGAMPLITUDE:dem.tif"), "DERIVED_SUBDATASET:LOGAMPLITUDE:$/dem.tif");
}

TEST_F(dataset_names, lead_to_the_file_whose_bytes_count) {
  const auto zip = scratch.write("dem.zip", "x"), nc = scratch.write("dem.nc", "x");
  EXPECT_EQ(file_behind("/vsizip/" + zip.string() + "/a/dem.tif"), zip);
  EXPECT_EQ(file_behind("NETCDF:\"" + nc.string() + "\":z"), nc);
  EXPECT_EQ(file_behind("NETCDF:\"/vsizip/" + zip.string() + "/dem.nc\":z"), zip);
  EXPECT_EQ(file_behind("NETCDF:\"/not/there.nc\":z"), "/not/there.nc");
  for (const char* plain : {"/a/b.tif", "b.tif", "", "PG:dbname=x"}) EXPECT_EQ(file_behind(plain), plain);
}

}  // namespace
}  // namespace talus
