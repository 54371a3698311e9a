// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The forms that the tangent's product with a vector is computed in.
#pragma once

namespace talus::solver {

/// How y = K x is computed: point by point from the stored tangents, from dense element matrices, or from the matrix
/// assembled as a stencil of node blocks.
enum class Operator { points, elements, stencil };

}  // namespace talus::solver
