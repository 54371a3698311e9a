// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-preprocess: from elevation models to domain.vdb.
#include "preprocess/stage.hpp"

int main(int argc, char** argv) { return talus::run_stage(argc, argv, talus::preprocess::stage()); }
