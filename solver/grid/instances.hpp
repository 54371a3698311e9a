// Templates of the linear algebra are compiled once, at the foot of their .cu: for both precisions, both places and all
// shapes.
#pragma once

#include "solver/grid/shape_functions.hpp"
#include "solver/parallel/place.hpp"

#define TALUS_FOR_EACH_SHAPE(instantiate, Real, Place) \
  instantiate(Real, Place, Linear) instantiate(Real, Place, Quadratic) instantiate(Real, Place, Gimp)
#define TALUS_FOR_EACH_PRECISION(instantiate, Place) \
  TALUS_FOR_EACH_SHAPE(instantiate, float, Place) TALUS_FOR_EACH_SHAPE(instantiate, double, Place)

/// instantiate(Real, Place, Shape) for all there are.
#if TALUS_FOR_GPU
#define TALUS_FOR_EACH_INSTANCE(instantiate) \
  TALUS_FOR_EACH_PRECISION(instantiate, OnCpu) TALUS_FOR_EACH_PRECISION(instantiate, OnGpu)
#else
#define TALUS_FOR_EACH_INSTANCE(instantiate) TALUS_FOR_EACH_PRECISION(instantiate, OnCpu)
#endif
