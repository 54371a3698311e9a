// Marks functions that run in both places.
#pragma once

#if defined(__CUDACC__)
#define TALUS_HD __host__ __device__ __forceinline__
#else
#define TALUS_HD inline
#endif
