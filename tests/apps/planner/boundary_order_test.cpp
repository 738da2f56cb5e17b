// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// Kriegel's choice among made-up proposals.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

#include "viewgain/planner_mesh/policies.hpp"

namespace viewgain {
namespace {

constexpr double kSamePlace = 0.03;   // [m]
constexpr std::size_t kVariants = 4;  // of a patch, the first one nominal

// Runs of patches, and candidates for all of them but those that are left out.
struct MadeUp {
  EstimatedViews estimated;
  std::vector<Candidate> candidates;

  // Patches 0.06 m apart along x from `x` on; returns the index of the first one.
  std::size_t add_run(BoundaryClass boundary_class, double length, std::size_t patches, double x) {
    const std::size_t first = estimated.patches.size();
    const auto run = static_cast<std::uint32_t>(estimated.runs.size());
    estimated.runs.push_back({boundary_class, 0, {}, {}, false, length, 0});
    for (std::size_t p = 0; p < patches; ++p) {
      QuadraticPatch patch;
      patch.origin = {x + 0.06 * static_cast<double>(p), 0, 0};
      for (std::size_t v = 0; v < kVariants; ++v) {
        BoundaryCandidate c;
        c.boundary_class = boundary_class;
        c.run = run;
        c.patch = static_cast<std::uint32_t>(estimated.patches.size());
        c.nominal = v == 0;
        candidates.push_back(
            {c.T_world_camera, "boundary", boundary_class, estimated.candidates.size()});
        estimated.candidates.push_back(c);
      }
      estimated.patches.push_back(patch);
      estimated.run_of_patch.push_back(run);
    }
    return first;
  }

  // As if the patch's nominal pose were not feasible.
  void drop_nominal(std::size_t patch) {
    std::erase_if(candidates, [&](const Candidate& c) {
      const BoundaryCandidate& b = estimated.candidates[*c.number];
      return b.patch == patch && b.nominal;
    });
  }

  // The patch that is chosen; checks that it is its nominal pose.
  std::optional<std::size_t> next(BoundaryOrder& order) const {
    const std::optional<std::size_t> chosen = order.next(candidates, estimated);
    if (!chosen) return std::nullopt;
    const BoundaryCandidate& c = estimated.candidates[*candidates[*chosen].number];
    EXPECT_TRUE(c.nominal);
    return c.patch;
  }
};

TEST(BoundaryOrder, LeftRightTopBottomWhateverTheOrderOfTheList) {
  std::array classes{BoundaryClass::left, BoundaryClass::right, BoundaryClass::top,
                     BoundaryClass::bottom};
  int cases = 0;
  do {
    MadeUp made;
    std::array<std::size_t, 4> patch_of{};
    for (std::size_t i = 0; i < 4; ++i) {
      // The later classes have the longer runs.
      const auto k = static_cast<std::size_t>(classes[i]);
      patch_of[k] =
          made.add_run(classes[i], 0.1 * static_cast<double>(k + 1), 1, static_cast<double>(i));
    }
    BoundaryOrder order(kSamePlace);
    for (const std::size_t patch : patch_of) EXPECT_EQ(made.next(order), patch);
    EXPECT_EQ(made.next(order), std::nullopt);
    ++cases;
  } while (std::next_permutation(classes.begin(), classes.end()));
  EXPECT_EQ(cases, 24);
}

TEST(BoundaryOrder, WithinAClassTheLongestRunThenTheFirst) {
  MadeUp made;
  const std::size_t shorter = made.add_run(BoundaryClass::top, 0.1, 1, 0);
  const std::size_t longest = made.add_run(BoundaryClass::top, 0.3, 1, 1);
  const std::size_t equal = made.add_run(BoundaryClass::top, 0.1, 1, 2);
  BoundaryOrder order(kSamePlace);
  EXPECT_EQ(made.next(order), longest);
  EXPECT_EQ(made.next(order), shorter);
  EXPECT_EQ(made.next(order), equal);
  EXPECT_EQ(made.next(order), std::nullopt);
}

TEST(BoundaryOrder, NominalPosesAlone) {
  MadeUp made;
  const std::size_t left = made.add_run(BoundaryClass::left, 0.2, 1, 0);
  const std::size_t bottom = made.add_run(BoundaryClass::bottom, 0.1, 1, 1);
  made.drop_nominal(left);
  BoundaryOrder order(kSamePlace);
  EXPECT_EQ(made.next(order), bottom);
  EXPECT_EQ(made.next(order), std::nullopt);  // seven tilted and rolled ones are left
  EXPECT_EQ(made.candidates.size(), 2 * kVariants - 1);
}

TEST(BoundaryOrder, ARunIsTriedOnceAtItsMiddle) {
  MadeUp made;
  const std::size_t left = made.add_run(BoundaryClass::left, 0.3, 5, 0);
  const std::size_t right = made.add_run(BoundaryClass::right, 0.2, 4, 2);
  made.drop_nominal(right + 1);  // of the two patches beside the middle
  BoundaryOrder order(kSamePlace);
  EXPECT_EQ(made.next(order), left + 2);
  EXPECT_EQ(made.next(order), right + 2);
  EXPECT_EQ(made.next(order), std::nullopt);
}

TEST(BoundaryOrder, ARunIsKnownAgainByClassAndPlace) {
  BoundaryOrder order(kSamePlace);
  MadeUp first;
  first.add_run(BoundaryClass::left, 0.06, 1, 0);
  EXPECT_EQ(first.next(order), 0U);
  struct Case {
    BoundaryClass boundary_class;
    double x;  // [m]
    bool is_new;
  };
  const std::vector<Case> later{{BoundaryClass::left, 0.0, false},
                                {BoundaryClass::left, 0.029, false},
                                {BoundaryClass::left, -0.031, true},
                                {BoundaryClass::right, 0.0, true}};
  for (const Case& c : later) {
    BoundaryOrder now = order;
    MadeUp made;
    made.add_run(c.boundary_class, 0.06, 1, c.x);
    EXPECT_EQ(made.next(now).has_value(), c.is_new) << c.x;
  }
  // A longer run that holds the place, cut anew.
  MadeUp longer;
  longer.add_run(BoundaryClass::left, 0.3, 5, -0.13);
  EXPECT_EQ(longer.next(order), std::nullopt);
}

TEST(BoundaryOrder, PosesWithoutAClassAreNobodysBoundary) {
  MadeUp made;
  made.candidates = {{{}, "reach", std::nullopt, 0U}, {{}, "reach"}};
  BoundaryOrder order(kSamePlace);
  EXPECT_EQ(made.next(order), std::nullopt);
  const std::size_t bottom = made.add_run(BoundaryClass::bottom, 0.1, 1, 0);
  EXPECT_EQ(made.next(order), bottom);
}

}  // namespace
}  // namespace viewgain
