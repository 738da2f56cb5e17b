// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/room.hpp"

#include <sys/mman.h>

#include <new>

namespace viewgain {

void check_room(std::size_t bytes) {
  // Not from an allocator, which would keep the memory in its heap.
  void* const room =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) throw std::bad_alloc();
  ::munmap(room, bytes);
}

}  // namespace viewgain
