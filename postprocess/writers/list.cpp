// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// All outputs of a run.
#include "postprocess/options/writer.hpp"

namespace talus::postprocess {

std::shared_ptr<Writer> geotiff_writer();    // maps/geotiff.cpp
std::shared_ptr<Writer> gis_writer();        // maps/gis.cpp
std::shared_ptr<Writer> hazard_writer();     // maps/hazard_maps.cpp
std::shared_ptr<Writer> avaframe_writer();   // maps/avaframe.cpp
std::shared_ptr<Writer> netcdf_writer();     // maps/netcdf.cpp
std::shared_ptr<Writer> vtk_writer();        // three_d/three_d.cpp
std::shared_ptr<Writer> picture_writer();    // picture/map_picture.cpp
std::shared_ptr<Writer> animation_writer();  // picture/animation.cpp
std::shared_ptr<Writer> history_writer();    // maps/history_files.cpp
std::shared_ptr<Writer> buildings_writer();  // maps/hazard_maps.cpp
std::shared_ptr<Writer> used_writer();       // writers/texts.cpp
std::shared_ptr<Writer> report_writer();     // report/report.cpp
std::shared_ptr<Writer> score_writer();      // writers/texts.cpp

/// The scores come last: score.json marks complete results.
std::vector<std::shared_ptr<Writer>> all_writers() {
  return {geotiff_writer(), gis_writer(),     hazard_writer(),    avaframe_writer(), netcdf_writer(),
          vtk_writer(),     picture_writer(), animation_writer(), history_writer(),  buildings_writer(),
          used_writer(),    report_writer(),  score_writer()};
}

}  // namespace talus::postprocess
