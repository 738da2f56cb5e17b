// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "recordings/transform_tree.hpp"

namespace viewgain {

inline constexpr std::int64_t kNanoseconds = 1'000'000'000;  ///< in a second

/// "1700000000.250" for a time stamp [ns].
[[nodiscard]] std::string seconds_text(std::int64_t stamp);

/// Counts images without a pose from the transforms, by reason.
class MissingPoses {
 public:
  /// `why` must not be Found::yes; `stamp` is that of the image [ns].
  void add(TransformTree::Found why, std::int64_t stamp);

  [[nodiscard]] bool empty() const noexcept { return to_ == INT64_MIN; }

  /// The counts, and the time spans of the transforms of `chain` and of these images. `are_all`: no
  /// image has a pose.
  [[nodiscard]] std::string text(const TransformTree::Chain& chain, bool are_all) const;

 private:
  std::array<std::size_t, 4> counts_{};             // before, after, in gaps, without a chain
  std::int64_t from_ = INT64_MAX, to_ = INT64_MIN;  // of these images [ns]
};

}  // namespace viewgain
