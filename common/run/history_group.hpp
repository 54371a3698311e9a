// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Group /history of run.h5 and of checkpoint.h5: a data set per column, unit, quantity and place as its attributes.
#pragma once

#include "common/run/hdf5.hpp"
#include "common/run/run_file.hpp"

namespace talus {

/// Makes the group and writes every column. Throws DataError when the file cannot take it.
void write_history(h5::File& file, const RunHistory& history);

/// Reads the columns in the order they were written; files older than the attributes give empty words. Throws DataError
/// when the group is missing or its columns differ in length.
RunHistory read_history(const h5::File& file);

}  // namespace talus
