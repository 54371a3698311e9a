// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve: from domain.vdb to run.h5.
#include "solver/stage.hpp"

int main(int argc, char** argv) { talus::solver::end_process(talus::run_stage(argc, argv, talus::solver::stage())); }
