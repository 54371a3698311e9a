// The maps a run hands on: names, units and words, in one place for GeoTIFF and NetCDF.
#pragma once

#include <string>
#include <vector>

#include "common/run/run_file.hpp"

namespace talus::postprocess {

struct Field {
  const char* name;  // file name and NetCDF variable
  std::vector<double> RunMaps::*values;
  const char* unit;  // UDUNITS
  const char* long_name;
  const char* cell_methods;  // CF; "" = none
  bool zero_inside;          // nodata inside the domain means zero (arrival time: it never came)
};

/// deposit_thickness, peak_thickness, peak_speed, peak_pressure, arrival_time.
const std::vector<Field>& product_fields();

/// True where the run has ground, or mass in spite of it: there zero is a value; elsewhere it is nodata.
std::vector<char> inside_domain(const RunMaps& maps);

/// One field as a raster: NaN outside the domain, 0 inside it where nothing is (arrival time: NaN).
Raster field_raster(const RunMaps& maps, const Field& field);

/// Values on the run's grid as a raster: NaN outside the domain; with `zero_inside` 0 for NaN inside it.
Raster values_raster(const RunMaps& maps, const std::vector<double>& values, bool zero_inside);

/// A name as part of a file's: letters, digits, dots and dashes, "-" for anything else.
std::string file_word(const std::string& name);

/// Volume under a thickness raster, NaN as nothing [m3]. Summed in extended precision: it is compared to 1e-9.
double volume_under(const std::vector<double>& thickness, double cell);

}  // namespace talus::postprocess
