// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/room.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <new>

namespace viewgain {
namespace {

TEST(Room, IsThereOrIsNot) {
  // Not kept: 640 GiB in all.
  for (int i = 0; i < 10000; ++i) EXPECT_NO_THROW(check_room(std::size_t{1} << 26U));
  EXPECT_THROW(check_room(std::size_t{1} << 60U), std::bad_alloc);  // beyond any address
}

}  // namespace
}  // namespace viewgain
