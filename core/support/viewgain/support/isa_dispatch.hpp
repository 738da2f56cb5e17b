// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

#include "viewgain/support/isa.hpp"

/// @file
/// For source files that Highway compiles once per instruction set. Use the macro after HWY_ONCE.
/// VIEWGAIN_OF_ISA(isa, function) is the version of the function for `isa`, or if the build has
/// none, for the lowest set of the build.

#if HWY_TARGETS & HWY_AVX3
#define VIEWGAIN_IF_AVX512(isa, function) (isa) == ::viewgain::Isa::avx512 ? N_AVX3::function:
#else
#define VIEWGAIN_IF_AVX512(isa, function)
#endif
#if HWY_TARGETS & HWY_AVX2
#define VIEWGAIN_IF_AVX2(isa, function) (isa) == ::viewgain::Isa::avx2 ? N_AVX2::function:
#else
#define VIEWGAIN_IF_AVX2(isa, function)
#endif
#define VIEWGAIN_OF_ISA(isa, function)                                                       \
  (static_cast<void>(isa), VIEWGAIN_IF_AVX512(isa, function) VIEWGAIN_IF_AVX2(isa, function) \
                               HWY_STATIC_DISPATCH(function))
