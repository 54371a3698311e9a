// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-postprocess: from run.h5 to maps, scores and the report.
#include "postprocess/stage.hpp"

int main(int argc, char** argv) { return talus::run_stage(argc, argv, talus::postprocess::stage()); }
