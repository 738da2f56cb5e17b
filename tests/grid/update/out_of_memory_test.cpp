// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Integration while memory runs out. A program of its own, since it replaces operator new.

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <tuple>
#include <vector>

#include "core/replaced_new.hpp"
#include "core/temporary_folder.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/belief_block.hpp"

namespace {

/// Allocations until one fails; negative: none does.
std::atomic<long> allocations_left{-1};

}  // namespace

void on_allocation(std::size_t /*size*/) {
  if (allocations_left.load() >= 0 && allocations_left.fetch_sub(1) <= 0) throw std::bad_alloc();
}

namespace viewgain {
namespace {

using namespace test;

/// What a snapshot tells, in an order of its own.
std::vector<std::tuple<int, int, int, LeafMask, LeafMask, const BeliefBlock*>> leaves_of(
    const GridSnapshot& snapshot) {
  std::vector<std::tuple<int, int, int, LeafMask, LeafMask, const BeliefBlock*>> leaves;
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    leaves.emplace_back(leaf.origin.x, leaf.origin.y, leaf.origin.z, leaf.non_free, leaf.occupied,
                        leaf.beliefs.get());
  }
  return leaves;
}

std::uint64_t hits_of(const BeliefGrid& grid) {
  std::uint64_t hits = 0;
  for (const BeliefBlockAt& block : belief_blocks(grid)) {
    for (const Belief& belief : block.beliefs->beliefs) hits += belief.hits;
  }
  return hits;
}

TEST(OutOfMemory, WhatAFrameLeftUndoneIsSeenByTheNextSnapshot) {
  const Sensor sensor = small_sensor(32, 24);
  const DepthFrame first = see_spheres(sensor, ring_view(0), three_spheres_in_a_room());
  const DepthFrame second = see_spheres(sensor, ring_view(1), three_spheres_in_a_room());
  BeliefGrid start(object_grid(64));
  FrameIntegrator(sensor).integrate(start, first, ring_view(0));
  BeliefGrid whole = start.clone();
  FrameIntegrator(sensor).integrate(whole, second, ring_view(1));

  const TemporaryFolder folder;
  int failed = 0, written = 0, hollow = 0, with_new_beliefs = 0;
  for (long count = 0;; count += 1 + count / 20) {
    BeliefGrid grid = start.clone();
    const GridSnapshot before = grid.snapshot();
    FrameIntegrator integrator(sensor);
    bool enough = true;
    allocations_left = count;
    try {
      integrator.integrate(grid, second, ring_view(1));
    } catch (const std::bad_alloc&) {
      enough = false;
    }
    allocations_left = -1;
    const GridSnapshot updated = grid.snapshot(before), anew = grid.snapshot();
    ASSERT_EQ(leaves_of(updated), leaves_of(anew)) << count;
    ASSERT_EQ(updated.tiles.size(), anew.tiles.size()) << count;
    if (enough) {
      EXPECT_EQ(grid.content_hash(), whole.content_hash());
      break;
    }
    ++failed;
    written += leaves_of(anew) != leaves_of(before);
    EXPECT_EQ(grid.views().size(), 1U);
    for (const BeliefBlockAt& block : belief_blocks(grid)) {
      hollow += block.beliefs->beliefs.empty();
    }
    // It stays a map: what is saved can be loaded, and another frame goes in.
    save_vdb(grid, folder.path() / "map.vdb");
    ASSERT_EQ(load_vdb(folder.path() / "map.vdb").content_hash(), grid.content_hash()) << count;
    with_new_beliefs += hits_of(grid) != hits_of(start);
    integrator.integrate(grid, second, ring_view(1));
    EXPECT_EQ(grid.views().size(), 2U);
    // The integrator goes on with nothing of the frame that failed.
    BeliefGrid other = start.clone();
    integrator.integrate(other, second, ring_view(1));
    ASSERT_EQ(other.content_hash(), whole.content_hash()) << count;
  }
  EXPECT_GT(failed, 30);
  EXPECT_GT(written, 10);
  EXPECT_EQ(hollow, 0);
  EXPECT_GT(with_new_beliefs, 10);
}

}  // namespace
}  // namespace viewgain
