// The rasterizer as it would be if a pixel's centre were enough: to measure what whole pixels cost. Not sound.
// SPDX-License-Identifier: MIT
//
// The drawing is built a second time, here, with other names for all that depends on the switch: what it exports, and the
// namespaces of the instruction sets, in which all else of it lies. The library itself has no trace of this.
#define SIGHTLINE_RASTER_CENTERS
#define drawCluster drawClusterByCenters

#define N_SCALAR N_SCALAR_CENTERS
#define N_EMU128 N_EMU128_CENTERS
#define N_SSSE3 N_SSSE3_CENTERS
#define N_SSE4 N_SSE4_CENTERS
#define N_AVX2 N_AVX2_CENTERS
#define N_AVX3 N_AVX3_CENTERS
#define N_AVX3_DL N_AVX3_DL_CENTERS
#define N_NEON N_NEON_CENTERS
#define N_SVE N_SVE_CENTERS
#define N_SVE2 N_SVE2_CENTERS
#define N_SVE_256 N_SVE_256_CENTERS
#define N_SVE2_128 N_SVE2_128_CENTERS
#define N_PPC8 N_PPC8_CENTERS
#define N_WASM N_WASM_CENTERS
#define N_WASM_EMU256 N_WASM_EMU256_CENTERS
#define N_RVV N_RVV_CENTERS

#include "sightline/raster/draw.cpp"
