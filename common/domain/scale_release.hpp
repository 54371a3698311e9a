// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// More or less of the same release, without seeding it again.
#pragma once

#include "common/domain/domain.hpp"

namespace talus {

/// This function multiplies the vertical thickness of what is released by `factor` > 0: release_thickness, the volumes
/// of the released points and their heights above the ground that they lie on (the bed, or the erodible layers under
/// them). The bed stays, and so does the outline; the surface before the failure follows the thickness. Erodible
/// ground stays as it is, and the mask of active cells is dropped, since points may stand in other layers. Layers of
/// points are stretched: as many points stand for more or less height, while talus-preprocess would seed others. Throws
/// std::logic_error for a factor that is not positive.
void scale_release(Domain& domain, double factor);

}  // namespace talus
