// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-make-terrain KIND --out DIR: writes one of the synthetic terrains; paths go to stdout.
#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "common/error.hpp"
#include "common/stage/stage.hpp"
#include "data_samples/hard_terrains.hpp"
#include "data_samples/terrains.hpp"
#include "data_samples/write_sample.hpp"

namespace {

using namespace talus::samples;

/// The terrain of a kind, with cells of this size [m], laid on the map. Throws RecipeError where it cannot be laid so.
using Maker = std::function<Sample(double cell, const Pose& pose)>;

Maker fixed(Sample (*made)(double cell)) {
  return [made](double cell, const Pose& pose) {
    if (pose.mirrored || pose.turned_deg != 0)
      throw talus::RecipeError({"this terrain cannot be mirrored or turned",
                                "rough-slope, bent-gully, cliff-bench, thinning-slide and weathered-slope alone are "
                                "given on axes of their own",
                                "Leave out --mirror and --turn, or make one of those"});
    return made(cell);
  };
}
Maker laid(HardTerrain (*terrain)()) {
  return [terrain](double cell, const Pose& pose) { return LaidTerrain(terrain(), cell, pose).sample(); };
}

const std::map<std::string, Maker> kinds{{"bent-gully", laid(bent_gully)},
                                         {"cliff-bench", laid(cliff_bench)},
                                         {"inclined-plane", fixed(inclined_plane)},
                                         {"parabolic-chute", fixed(parabolic_chute)},
                                         {"raw-valley", fixed([](double cell) { return raw_valley(cell, 1); })},
                                         {"rock-slope", fixed(rock_slope)},
                                         {"rough-slope", laid(rough_slope)},
                                         {"thinning-slide", laid(thinning_slide)},
                                         {"valley", fixed(valley)},
                                         {"weathered-slope", laid(weathered_slope)}};

std::string names() {
  std::string all;
  for (const auto& [name, maker] : kinds) all += (all.empty() ? "" : ", ") + name;
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes a small synthetic terrain: elevation models, outlines and release thickness.",
               "talus-make-terrain"};
  std::string kind, out;
  double cell = 10;
  app.add_option("kind", kind, "One of " + names())
      ->required()
      ->type_name("KIND")
      ->check(CLI::IsMember(kinds).description(""));
  app.add_option("--out", out, "Folder to write to, made if missing")->required()->type_name("DIR");
  app.add_option("--cell", cell, "Cell size [m], 0.5 to 50 (default: 10)")
      ->type_name("M")
      ->check(CLI::Range(0.5, 50.0).description(""));
  Pose pose;
  app.add_flag("--mirror", pose.mirrored, "Left for right, seen down the slope");
  app.add_option("--turn", pose.turned_deg, "Counter-clockwise [degrees], -360 to 360 (default: 0)")
      ->type_name("DEG")
      ->check(CLI::Range(-360.0, 360.0).description(""));
  app.set_version_flag("--version", "talus-make-terrain " + talus::version(), "Print the version and its commit");
  try {
    app.parse(argc, argv);
    for (const auto& file : talus::samples::write_sample(out, kinds.at(kind)(cell, pose)))
      std::cout << file.string() << "\n";
  } catch (const CLI::ParseError& fault) {
    return app.exit(fault) == 0 ? 0 : static_cast<int>(talus::ExitCode::recipe);
  } catch (const talus::Error& error) {
    std::cerr << "talus-make-terrain: " << error.what() << "\n";
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::cerr << "talus-make-terrain: " << error.what() << "\n";
    return static_cast<int>(talus::ExitCode::data);
  }
  return 0;
}
