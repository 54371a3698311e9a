#include <algorithm>
#include <cmath>

#include "data_samples/terrains.hpp"

namespace talus::samples {

namespace {

constexpr double width = 3600, height = 1600, middle = 800;
constexpr double crest = 350, run = 2600, top = 3431, river = 2250;  // [m]

double ground(double x, double y) {
  const double s = std::clamp((x - crest) / run, 0.0, 1.0), aside = y - middle;
  double z = river + (top - river) * std::pow(1 - s, 1.8);
  z -= 0.35 * std::max(0.0, crest - x);                            // the far side of the crest
  z += 0.45 * std::max(0.0, x - crest - run - 80);                 // the other bank
  z += 70 * std::sin(M_PI * s) * (1 - std::exp(-aside * aside / (2 * 260.0 * 260.0)));  // a gully down the middle
  return z + 7 * noise(x / 320, y / 320, 11) + 2.5 * noise(x / 95, y / 95, 12);
}

struct Scar {
  double x, along, across, depth, steepness;  // centre, half axes, depth [m]; power of the rim
  double at(double px, double py) const {
    const double r = std::hypot((px - x) / along, (py - middle) / across);
    return r < 1 ? depth * (1 - std::pow(r, steepness)) : 0;
  }
};
constexpr Scar area_a{620, 215, 185, 45, 6}, area_b{1450, 440, 180, 8, 8};

}  // namespace

Sample rock_slope(double cell) {
  Sample sample;
  sample.rasters.emplace_back("before_dem", raster_of(width, height, cell, ground));
  sample.rasters.emplace_back("after_dem", raster_of(width, height, cell, [](double x, double y) {
                                return ground(x, y) - area_a.at(x, y) - area_b.at(x, y);
                              }));
  return sample;
}

}  // namespace talus::samples
