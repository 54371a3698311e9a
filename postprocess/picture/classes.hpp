// Thickness classes and their colours.
#pragma once

#include <string>
#include <vector>

namespace talus::postprocess {

struct Colour {
  double r = 0, g = 0, b = 0;  // sRGB, 0 to 1
};

/// Lower limits as given; if none are: 0.1|5|10|25|50|100 m (rock avalanches), or 0.1|0.5|1|2|5|10 m below 12 m.
std::vector<double> class_limits(const std::vector<double>& given, double thickest);

/// Colour of class `index` of `count`: from pale yellow (thin) over orange and red to near black (thick). Lightness
/// falls in equal steps of OKLab (Ottosson 2020), so equal steps look equal and the order survives any colour
/// blindness.
Colour class_colour(std::size_t index, std::size_t count);

/// Index of the class that holds the value; -1 below the first limit or for NaN.
int class_of(double value, const std::vector<double>& limits);

/// "5 - 10" with an en dash, "> 100" for the last.
std::string class_label(std::size_t index, const std::vector<double>& limits);

/// Lightness of a colour in OKLab, 0 black to 1 white.
double oklab_lightness(const Colour& colour);

}  // namespace talus::postprocess
