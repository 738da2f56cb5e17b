// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/expect_error.hpp"
#include "grid/hazard/cut_grid.hpp"
#include "oracle/surface.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain {
namespace {

using test::cut_grid, test::kVoxel;

// `hits` readings with this sigma [m].
void put(BeliefGrid& grid, Index3 voxel, std::uint32_t hits, double sigma = 0.005) {
  Belief belief;
  const auto information = static_cast<float>(hits / (sigma * sigma));
  belief.information = {information, information, information, 0, 0, 0};
  belief.hits = hits;
  grid.set(voxel, 1.0F, belief);
}

Index3 any_voxel(const BeliefGrid& grid, std::mt19937& random) {
  const Index3 base = grid.min_index();
  const auto any = [&](int size) {
    return std::uniform_int_distribution<int>(0, size - 1)(random);
  };
  return {base.x + any(grid.dims().x), base.y + any(grid.dims().y), base.z + any(grid.dims().z)};
}

TEST(HazardField, DistancesAreThoseOfBruteForce) {
  std::mt19937 random(7);
  std::size_t checks = 0, finite = 0;
  for (int shift = 0; shift < 4; ++shift) {
    BeliefGrid grid = cut_grid({41, 29, 35});
    const auto voxel = [&] { return any_voxel(grid, random); };
    for (int k = 0; k < 5; ++k) put(grid, voxel(), 3);
    for (int k = 0; k < 50; ++k) {  // too little evidence
      const Index3 v = voxel();
      if (!grid.belief(v)) put(grid, v, 2);
    }
    const HazardConfig::Model model{30.0, 4 * kVoxel * (1 << shift), 0.5};
    const HazardField field(grid.snapshot(), {.model = model});
    ASSERT_EQ(field.cell_shift(), shift);
    for (int k = 0; k < 2000; ++k) {
      const Index3 v = voxel();
      const double expected = oracle::distance_to_evidence(grid, shift, v);
      ++checks;
      if (expected > HazardConfig::Model::kCut * model.decay_length + 1e-9) {
        EXPECT_TRUE(std::isinf(field.distance(v)));
        EXPECT_EQ(field.rate(v), 0.5F);
        EXPECT_TRUE(field.is_new(v));
        continue;
      }
      ++finite;
      EXPECT_NEAR(field.distance(v), expected, 1e-12);
      const double shape = field.shape(v);
      EXPECT_NEAR(field.rate(v), 0.5 + 30.0 * shape * std::exp(-expected / model.decay_length),
                  1e-5);
      EXPECT_NEAR(field.start_rate(v), field.rate(v), 1e-5);
      EXPECT_EQ(field.is_new(v), expected > kVoxel * std::max(1.2, 1.0 * (1 << shift)) + 1e-9);
    }
  }
  EXPECT_EQ(checks, 8000U);
  EXPECT_GT(finite, 3000U);
}

// What HazardConfig::Model::continuation() times openness() is at a voxel for each of the nearest
// cells with evidence, from the definition; the near box's faces go on beyond it.
std::vector<double> shapes(const BeliefGrid& grid, const HazardField& field, Index3 voxel) {
  const int shift = field.cell_shift();
  const VoxelBox box = field.near_box();
  const auto cell_of = [&](Index3 v) {
    return Eigen::Vector3i(v.x >> shift, v.y >> shift, v.z >> shift);
  };
  const VoxelBox workspace = VoxelBox::from_dims(grid.min_index(), grid.dims());
  const auto share = [&](Eigen::Vector3i cell) {  // free voxels of those in the workspace
    double free = 0, all = 0;
    for (int i = 0; i < 1 << (3 * shift); ++i) {
      const int edge = 1 << shift;
      const Index3 v{(cell.x() << shift) + i % edge, (cell.y() << shift) + i / edge % edge,
                     (cell.z() << shift) + i / edge / edge};
      if (!workspace.contains(v)) continue;
      all += 1;
      free += grid.state(v) == VoxelState::free;
    }
    return free / all;
  };
  const Eigen::Vector3i low = cell_of(box.min),
                        high = cell_of({box.max.x - 1, box.max.y - 1, box.max.z - 1});
  const auto around = [&](const Eigen::Vector3i& cell) {
    const Eigen::Vector3i middle = cell.cwiseMax(low).cwiseMin(high);
    double sum = 0;
    for (int i = 0; i < 343; ++i) {
      const Eigen::Vector3i by(i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3);
      sum += share((middle + by).cwiseMax(low).cwiseMin(high));
    }
    return sum;
  };
  const Eigen::Vector3i here = cell_of(voxel);
  const double decay_length = field.model().decay_length;
  const double reach =
      std::floor(HazardConfig::Model::kOpenReach * decay_length / (kVoxel * (1 << shift)));
  const auto is_occupied = [&](const Eigen::Vector3i& cell) {
    bool any = false;
    grid.for_each_belief([&](Index3 v, const Belief&) { any = any || cell_of(v) == cell; });
    return any;
  };
  int open = 0;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3i by(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1);
    const double length = by.cast<double>().norm();
    for (int k = 1; length > 0 && (k == 1 || k * length <= reach); ++k) {
      const Eigen::Vector3i cell = here + k * by;
      if (cell != cell.cwiseMax(low).cwiseMin(high) || is_occupied(cell)) break;
      if (share(cell) == 1) {
        ++open;
        break;
      }
    }
  }
  int nearest = 1 << 30;
  std::vector<Eigen::Vector3i> cells;
  grid.for_each_belief([&](Index3 v, const Belief& belief) {
    if (belief.hits < 3) return;
    const int squared = (cell_of(v) - here).squaredNorm();
    if (squared < nearest) nearest = squared, cells.clear();
    if (squared == nearest) cells.push_back(cell_of(v));
  });
  std::vector<double> values;
  for (const Eigen::Vector3i& cell : cells) {
    Eigen::Vector3d n;
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3i step = Eigen::Vector3i::Unit(a);
      n[a] = around(cell + step) - around(cell - step);
    }
    const Eigen::Vector3d away = (here - cell).cast<double>();
    const double product = n.norm() * away.norm();
    values.push_back(
        HazardConfig::Model::continuation(product > 1e-9 ? n.dot(away) / product : 0.0) *
        HazardConfig::Model::openness(open / 26.0));
  }
  return values;
}

TEST(HazardField, ShapesAreThoseOfTheDefinition) {
  std::mt19937 random(27);
  std::size_t checks = 0, varied = 0;
  struct Case {
    Index3 dims;
    int shift;
  };
  // The last has rows of cells that take several words of bits.
  for (const auto& [dims, shift] :
       {Case{{29, 22, 26}, 0}, {{29, 22, 26}, 1}, {{29, 22, 26}, 2}, {{13, 12, 150}, 0}}) {
    BeliefGrid grid = cut_grid(dims);
    // Free on one side of a slope, and here and there.
    const Index3 base = grid.min_index();
    for (int i = 0; i < dims.x * dims.y * dims.z; ++i) {
      const Index3 at{i % dims.x, i / dims.x % dims.y, i / dims.x / dims.y};
      if (at.x + 2 * at.y - at.z > 20 || random() % 16 == 0)
        grid.set({base.x + at.x, base.y + at.y, base.z + at.z}, -1.0F, {});
    }
    for (int k = 0; k < 12; ++k) put(grid, any_voxel(grid, random), 3);
    const HazardConfig::Model model{30.0, 4 * kVoxel * (1 << shift), 0.5};
    const HazardField field(grid.snapshot(), {.model = model});
    ASSERT_EQ(field.cell_shift(), shift);
    for (int k = 0; k < 150; ++k) {
      const Index3 v = any_voxel(grid, random);
      if (grid.state(v) == VoxelState::free || std::isinf(field.distance(v))) continue;
      double off = 1;
      for (const double shape : shapes(grid, field, v)) {
        off = std::min(off, std::abs(shape - field.shape(v)));
        varied += shape > 0.05 && shape < 0.5;
      }
      EXPECT_LT(off, shift > 0 ? 0.01 : 1e-4);  // shares are whole voxels there
      ++checks;
    }
  }
  EXPECT_GT(checks, 150U);
  EXPECT_GT(varied, 100U);
}

TEST(HazardField, SameBitsForAnyNumberOfThreads) {
  std::mt19937 random(41);
  std::size_t near = 0, cells = 0;
  for (const double decay_cells : {4.0, 8.0, 16.0}) {
    BeliefGrid grid = cut_grid({61, 33, 75});
    for (int k = 0; k < 20000; ++k) grid.set(any_voxel(grid, random), -1.0F, {});
    for (int k = 0; k < 40; ++k) put(grid, any_voxel(grid, random), 3);
    const GridSnapshot snapshot = grid.snapshot();
    const HazardConfig config{.model = HazardConfig::Model{30.0, decay_cells * kVoxel, 0.5}};
    const HazardField alone(snapshot, config, {.num_threads = 1});
    for (const int threads : {2, 3, 7}) {
      const HazardField together(snapshot, config, {.num_threads = threads});
      ASSERT_EQ(together.near_box(), alone.near_box());
      const VoxelBox& box = alone.near_box();
      for (int x = box.min.x; x < box.max.x; ++x) {
        for (int y = box.min.y; y < box.max.y; ++y) {
          for (int z = box.min.z; z < box.max.z; ++z, ++cells) {
            const Index3 v{x, y, z};
            ASSERT_EQ(alone.distance(v), together.distance(v));
            ASSERT_EQ(alone.shape(v), together.shape(v));
            near += std::isfinite(alone.distance(v)) ? 1 : 0;
          }
        }
      }
    }
  }
  EXPECT_GT(cells, 1'000'000U);
  EXPECT_GT(near, cells / 2);
}

TEST(HazardField, ModelsHaveTheirFigures) {
  EXPECT_EQ(HazardConfig::Model::continuation(-0.4), 1.0);
  EXPECT_EQ(HazardConfig::Model::continuation(-1), 0.30);
  EXPECT_EQ(HazardConfig::Model::continuation(1), 0.032);
  EXPECT_NEAR(HazardConfig::Model::continuation(0.1), 0.405, 1e-12);
  EXPECT_EQ(HazardConfig::Model::openness(0), 0.25);
  EXPECT_EQ(HazardConfig::Model::openness(5.0 / 13), 1.0);
  EXPECT_NEAR(HazardConfig::Model::openness(6.5 / 13), 0.705, 1e-12);
  EXPECT_EQ(HazardConfig::Model::openness(1), 0.0005);
}

TEST(HazardField, VoxelsFinerThanTheFootprintCountTogether) {
  std::mt19937 random(17);
  std::size_t checks = 0, finite = 0, single = 0;
  for (int pooling = 0; pooling < 4; ++pooling) {
    const double footprint = 1.2 * kVoxel * (1 << pooling);
    BeliefGrid grid = cut_grid({41, 29, 35});
    const auto voxel = [&] { return any_voxel(grid, random); };
    for (int k = 0; k < 150; ++k) put(grid, voxel(), 1, footprint);
    const HazardConfig::Model model{30.0, 8 * kVoxel, 0.5};
    const HazardField field(grid.snapshot(), {.model = model});
    ASSERT_EQ(field.pooling().shift, pooling);
    for (int k = 0; k < 1000; ++k) {
      const Index3 v = voxel();
      const double expected =
          oracle::distance_to_evidence(grid, field.cell_shift(), v, field.pooling().shift);
      ++checks;
      if (pooling == 0) single += std::isinf(expected);
      if (expected > HazardConfig::Model::kCut * model.decay_length + 1e-9) {
        EXPECT_TRUE(std::isinf(field.distance(v)));
        continue;
      }
      ++finite;
      EXPECT_NEAR(field.distance(v), expected, 1e-12);
      const double cell = kVoxel * (1 << field.cell_shift());
      EXPECT_EQ(field.is_new(v), expected > std::max(1.2 * footprint, cell) + 1e-9);
    }
  }
  EXPECT_EQ(checks, 4000U);
  EXPECT_EQ(single, 1000U);  // one hit a voxel is no evidence by itself
  EXPECT_GT(finite, 1500U);
}

TEST(HazardField, WithoutEvidenceEverythingIsFar) {
  const BeliefGrid grid = cut_grid({16, 16, 70});
  const HazardField field(grid.snapshot());
  const HazardConfig::Model model =
      HazardConfig::Model::for_size(0.7);  // the workspace's longest side
  EXPECT_NEAR(field.model().near_rate, model.near_rate, 1e-9);
  EXPECT_NEAR(field.model().decay_length, model.decay_length, 1e-12);
  EXPECT_EQ(field.rate(grid.min_index()), static_cast<float>(field.model().far_rate));
  EXPECT_TRUE(field.is_new(grid.min_index()));
  EXPECT_TRUE(std::isinf(field.distance({1'000'000, 0, 0})));
}

TEST(HazardField, TheSizeIsThatOfTheEvidenceUnlessGiven) {
  BeliefGrid grid = cut_grid({64, 64, 64});
  const Index3 base = grid.min_index();
  put(grid, {base.x + 10, base.y + 10, base.z + 10}, 5);
  put(grid, {base.x + 29, base.y + 12, base.z + 10}, 5);
  EXPECT_NEAR(HazardField(grid.snapshot()).model().decay_length, 0.0457 * 0.20, 1e-12);
  EXPECT_NEAR(HazardField(grid.snapshot(), {.object_size = 0.5}).model().decay_length, 0.02285,
              1e-12);
}

TEST(HazardField, RatesFromElsewhere) {
  BeliefGrid grid = cut_grid({16, 16, 16});
  const Index3 base = grid.min_index();
  auto volume = std::make_shared<HazardConfig::Volume>();
  volume->box = VoxelBox::from_dims({base.x + 2, base.y, base.z}, {2, 3, 4});
  for (int i = 0; i < 24; ++i) volume->rates.push_back(static_cast<float>(i));
  volume->outside = 100;
  const HazardField field(grid.snapshot(), {.volume = volume});
  EXPECT_EQ(field.cell_shift(), 0);
  EXPECT_EQ(field.rate({base.x + 3, base.y + 2, base.z + 1}), 21.0F);
  EXPECT_EQ(field.rate({base.x + 4, base.y + 2, base.z + 1}), 100.0F);
}

TEST(HazardField, RefusesWhatIsOutOfBounds) {
  const GridSnapshot snapshot = cut_grid({8, 8, 8}).snapshot();
  const auto refuses = [&](const char* what, const HazardConfig& config) {
    test::expect_error(ErrorCode::invalid_argument, what,
                       [&] { (void)HazardField(snapshot, config); });
  };
  refuses("object size must be positive and finite, not 0", {.object_size = 0.0});
  refuses("object size must be positive and finite, not nan", {.object_size = std::nan("")});
  refuses("decay length", {.model = HazardConfig::Model{1.0, 0.0, 1.0}});
  refuses("rate near the surface must be at least 0 and finite, not -1",
          {.model = HazardConfig::Model{-1.0, 0.1, 1.0}});
  refuses("rate far from the surface must be at least 0 and finite, not inf",
          {.model = HazardConfig::Model{1.0, 0.1, HUGE_VAL}});
  auto volume = std::make_shared<HazardConfig::Volume>();
  volume->box = VoxelBox::from_dims({0, 0, 0}, {2, 2, 2});
  refuses("rates: 0, voxels: 8", {.volume = volume});
  auto negative = std::make_shared<HazardConfig::Volume>(*volume);
  negative->rates.assign(8, -1.0F);
  refuses("rate must be at least 0 and finite, not -1", {.volume = negative});
}

}  // namespace
}  // namespace viewgain
