// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What is refused before memory is taken, and what happens when there is no more. A program of its
// own, since it replaces operator new.

#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <string>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace {

std::atomic<long> in_use{0}, most_in_use{0};  // [bytes]
std::atomic<long> limit{-1};                  // of in_use; negative: none

void count(void* memory, long sign) {
  const long now = in_use.fetch_add(sign * static_cast<long>(::malloc_usable_size(memory))) +
                   sign * static_cast<long>(::malloc_usable_size(memory));
  long most = most_in_use.load();
  while (now > most && !most_in_use.compare_exchange_weak(most, now)) {
  }
}

}  // namespace

void* operator new(std::size_t size) {
  const long allowed = limit.load();
  if (allowed >= 0 && in_use.load() + static_cast<long>(size) > allowed) throw std::bad_alloc();
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  count(memory, 1);
  return memory;
}
void operator delete(void* memory) noexcept {
  if (memory != nullptr) count(memory, -1);
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace viewgain {
namespace {

using namespace test;

/// The call with so many bytes beyond what is in use; false if they did not do.
template <typename Call>
bool runs_within(long bytes, const Call& call) {
  limit.store(in_use.load() + bytes);
  try {
    call();
  } catch (const std::bad_alloc&) {
    limit.store(-1);
    return false;
  } catch (...) {
    limit.store(-1);
    throw;
  }
  limit.store(-1);
  return true;
}

/// The most bytes that a call has in use at once.
template <typename Call>
long peak_of(const Call& call) {
  const long before = in_use.load();
  most_in_use.store(before);
  call();
  return most_in_use.load() - before;
}

TEST(MemoryLimit, AThreadPoolThatCannotBeMadeEndsItsThreads) {
  int failed = 0, made = 0;
  for (long bytes = 0; bytes < 4000; bytes += 16) {
    const auto make = [] {
      ThreadPool pool(6);
      std::atomic<int> calls{0};
      pool.for_each_chunk(12, 1, [&](std::size_t, std::size_t) { calls.fetch_add(1); });
      EXPECT_EQ(calls.load(), 12);
    };
    ++(runs_within(bytes, make) ? made : failed);
  }
  EXPECT_GT(failed, 20);
  EXPECT_GT(made, 20);
}

TEST(MemoryLimit, ASetOfPosesThatIsNotThereTakesNoMemory) {
  const auto ask = [] {
    expect_error(ErrorCode::invalid_argument, "48, 80, 288 or 864, not 100000000",
                 [] { (void)literature_ring_poses(100'000'000, 1); });
  };
  EXPECT_LT(peak_of(ask), 1'000'000);
}

// Of three views.
BeliefGrid seen_grid() {
  const Sensor sensor = small_sensor(64, 48);
  BeliefGrid grid(object_grid(100));
  FrameIntegrator integrator(sensor);
  for (int view = 0; view < 3; ++view) {
    integrator.integrate(grid, see_spheres(sensor, ring_view(view), three_spheres_in_a_room()),
                         ring_view(view));
  }
  return grid;
}

TEST(MemoryLimit, SavingWithoutMemoryLeavesNothingBehind) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  const BeliefGrid grid = seen_grid();
  const auto save = [&] { save_vdb(grid, path, {.with_covariance = true}); };
  save();  // what OpenVDB and its threads keep is there from now on
  const long peak = peak_of(save);
  ASSERT_GT(peak, 2'000'000);
  const std::string whole = read_all(path);
  int failed = 0, saved = 0;
  for (int part = 0; part <= 120; part += 3) {
    ++(runs_within(peak * part / 100, save) ? saved : failed);
    EXPECT_EQ(folder.entries(), 1);
    EXPECT_EQ(load_vdb(path).content_hash(), grid.content_hash());
  }
  EXPECT_GT(failed, 15);
  EXPECT_GT(saved, 0);
  EXPECT_EQ(failed + saved, 41);
}

// OpenVDB's trees want memory to be taken down, and end the process where there is none.
TEST(MemoryLimit, LoadingWithoutMemoryIsToldOf) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  const BeliefGrid grid = seen_grid();
  save_vdb(grid, path);
  std::string hash;
  const auto load = [&] {
    try {
      hash = load_vdb(path).content_hash();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::capacity) << error.what();
      EXPECT_NE(std::string(error.what()).find("does not fit into memory"), std::string::npos);
      throw std::bad_alloc();
    }
  };
  load();  // what OpenVDB and its threads keep is there from now on
  const long peak = peak_of(load);
  ASSERT_GT(peak, 2'000'000);
  int failed = 0, loaded = 0;
  for (int part = 0; part <= 200; ++part) {
    hash.clear();
    if (runs_within(peak * part / 100, load)) {
      EXPECT_EQ(hash, grid.content_hash());
      ++loaded;
    } else {
      ++failed;
    }
  }
  EXPECT_GT(failed, 50);
  EXPECT_GT(loaded, 50);
}

}  // namespace
}  // namespace viewgain
