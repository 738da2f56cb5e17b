// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "layout_table.hpp"

namespace viewgain::layout_test {
namespace {

// A client compiled with -march=native and a library compiled without must mean the same by a type.
TEST(Layout, DoesNotDependOnTheInstructionSet) {
  std::size_t types = 0;
  for (; plain_table[types].name != nullptr; ++types) {
    ASSERT_STREQ(plain_table[types].name, avx512_table[types].name);
    EXPECT_EQ(plain_table[types].size, avx512_table[types].size) << plain_table[types].name;
    EXPECT_EQ(plain_table[types].alignment, avx512_table[types].alignment)
        << plain_table[types].name;
  }
  EXPECT_EQ(avx512_table[types].name, nullptr);
  EXPECT_GE(types, 65U);
}

}  // namespace
}  // namespace viewgain::layout_test
