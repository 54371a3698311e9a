// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of preconditioner of a linear system over the nodes.
#pragma once

namespace talus::solver {

/// The part of the system (T19) that z = B^-1 r inverts: its diagonal, a node's 3 x 3 block, a whole column of nodes,
/// Gauss-Seidel over columns forth and back, or a multigrid cycle with such sweeps.
enum class Preconditioner { diagonal, block, column, gauss_seidel, multigrid };

}  // namespace talus::solver
