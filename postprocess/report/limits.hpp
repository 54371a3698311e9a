// Class limits of the report's maps where those of thickness (picture/classes.hpp) do not fit.
#pragma once

#include <vector>

namespace talus::postprocess {

/// Lower limits [m/s]: 0.5|1|5|10|25|50, from 1 to 100 where the flow is faster than 60 m/s.
std::vector<double> speed_limits(double fastest);

/// Lower limits [kPa]: 1|3|5|10 for avalanches, in steps of 1 and 5 times powers of ten where the pressure is beyond 100.
std::vector<double> pressure_limits(double largest);

/// Upper limits of all classes but the last [s]: round, equal steps, about eight.
std::vector<double> time_limits(double latest);

/// Rising positive limits of a symmetric scale [m]: 1/5, 1/2 and the whole of a round number that 98 of 100 differences
/// do not exceed. NaN and 0 are left out.
std::vector<double> difference_limits(const std::vector<double>& differences);

}  // namespace talus::postprocess
