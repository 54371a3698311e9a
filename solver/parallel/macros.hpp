// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Marks functions that run on both devices.
#pragma once

#if defined(__CUDA_ARCH__)
#define TALUS_HD __host__ __device__ __forceinline__
#elif defined(__CUDACC__)
#define TALUS_HD __host__ __device__ inline
#else
#define TALUS_HD inline
#endif

#if defined(__CUDACC__)
#define TALUS_RARE __host__ __device__ __noinline__  // long and seldom run: out of the way of what is run always
#define TALUS_FOR_GPU 1  // this file is compiled for the GPU as well: instantiate templates for GpuDevice
#else
#define TALUS_RARE __attribute__((noinline))
#define TALUS_FOR_GPU 0
#endif

#if defined(__CUDA_ARCH__)
#define TALUS_ON_CPU 0  // for which device a function of both is being compiled
#define TALUS_UNROLL _Pragma("unroll")
#define TALUS_ROLL _Pragma("unroll 1")  // where fetching the instructions takes longer than a loop
#else
#define TALUS_ON_CPU 1
#define TALUS_UNROLL
#define TALUS_ROLL
#endif

// Compiled once for any x86-64 and once for one with AVX2 and FMA, which runs where the processor has them.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define TALUS_FOR_EACH_CPU target_clones("arch=x86-64-v3", "default")
#else
#define TALUS_FOR_EACH_CPU
#endif
