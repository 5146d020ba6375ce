// SPDX-License-Identifier: Apache-2.0
// Settings of Highway for kernels that are compiled once per instruction set. Include before Highway's
// headers.
#pragma once

// Sanitizers need only the smallest instruction set and AVX2 to find invalid accesses; all sets together
// would take minutes to compile. Processors with SSSE3 but without SSE4 are too rare to be worth their code,
// and no kernel uses what AVX3_DL has and AVX3 lacks.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#endif

// The scalar fallback also has four lanes. Kernels must not use operations that g++ before 12.3 compiles
// wrongly there (high halves of 16-bit products).
#define HWY_BROKEN_EMU128 0
