// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace viewgain::layout_test {

struct Layout {
  const char* name;
  std::size_t size;
  std::size_t alignment;
};

/// Ended by a null name.
extern const Layout plain_table[];
extern const Layout avx512_table[];

}  // namespace viewgain::layout_test
