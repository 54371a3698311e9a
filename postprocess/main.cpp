// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <optional>

#include "common/stage/stage.hpp"
#include "postprocess/compare/compare.hpp"
#include "postprocess/postprocess.hpp"

int main(int argc, char** argv) {
  std::optional<std::filesystem::path> against;
  talus::Stage stage = talus::postprocess::stage();
  stage.flags = {{.name = "--against",
                  .help = "Compare the run in --out with the one in this folder, write OUT/comparison.html, and stop",
                  .value = "DIR",
                  .set = [&](const std::string& folder) { against = folder; }}};
  stage.run = [&](talus::StageContext& context) {
    if (against) return talus::postprocess::compare(context, *against);
    talus::postprocess::run(context);
  };
  return talus::run_stage(argc, argv, stage);
}
