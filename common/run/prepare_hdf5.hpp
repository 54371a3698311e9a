// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Settings of HDF5 that count from its first call on.
#pragma once

namespace talus::h5 {

/// Switches off HDF5's file locks and its clean-up at exit. Every file of this project calls the function; a program
/// that uses GDAL before, whose drivers call HDF5, calls it first.
void prepare_library();

}  // namespace talus::h5
