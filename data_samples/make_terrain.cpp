// talus-make-terrain KIND --out DIR: writes one of the synthetic terrains; paths go to stdout.
#include <CLI/CLI.hpp>
#include <iostream>
#include <map>
#include <string>

#include "common/error.hpp"
#include "data_samples/terrains.hpp"
#include "data_samples/write_sample.hpp"

namespace {

using talus::samples::Sample;

const std::map<std::string, Sample (*)(double)> kinds{
    {"inclined-plane", talus::samples::inclined_plane},
    {"parabolic-chute", talus::samples::parabolic_chute},
    {"raw-valley", [](double cell) { return talus::samples::raw_valley(cell, 1); }},
    {"rock-slope", talus::samples::rock_slope},
    {"valley", talus::samples::valley}};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes a small synthetic terrain: elevation models, outlines and release thickness."};
  std::string kind, out;
  double cell = 10;
  app.add_option("kind", kind, "inclined-plane, parabolic-chute, raw-valley, rock-slope or valley")
      ->required()
      ->check(CLI::IsMember(kinds));
  app.add_option("--out", out, "folder to write to")->required();
  app.add_option("--cell", cell, "cell size [m]")->check(CLI::Range(0.5, 50.0))->capture_default_str();
  try {
    app.parse(argc, argv);
    for (const auto& file : talus::samples::write_sample(out, kinds.at(kind)(cell))) std::cout << file.string() << "\n";
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
