// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace viewgain::detail {

/// Splits polygons in space into triangles that fill them: a fan of the first corner where that
/// does, else by clipping ears. It is looked at along the axis nearest to its normal, so it need
/// not be quite plane; it may touch itself, as one does whose holes are joined to its rim. Cost:
/// linear for a fan, else quadratic.
class EarClipping {
 public:
  void clear() { corners_.clear(); }
  void add(const std::array<double, 3>& corner) { corners_.push_back(corner); }

  /// Of four corners or more. False if no triangles fill the polygon; reason() is then why.
  [[nodiscard]] bool split();
  /// All but two of the corners' number; three numbers of corners each, turning as the polygon
  /// does.
  [[nodiscard]] const std::vector<std::array<std::size_t, 3>>& triangles() const {
    return triangles_;
  }
  /// "crosses itself".
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  struct Flat {
    double x, y;
    bool operator==(const Flat&) const = default;
  };

  double flatten();  // returns twice the area
  bool add_fan();
  [[nodiscard]] bool has_area() const;
  [[nodiscard]] bool crosses_itself() const;
  [[nodiscard]] bool is_ear(std::size_t corner) const;
  [[nodiscard]] double height_at(std::size_t corner) const;
  void clip(std::size_t corner);
  bool clip_all();

  std::vector<std::array<double, 3>> corners_;
  std::vector<Flat> flat_;                   // turning to the left
  std::vector<std::size_t> before_, after_;  // of the corners that are left
  std::vector<char> is_ear_;
  double no_area_ = 0;  // what rounding makes of none, twice an area
  double slack_ = 0;    // how deep it may cut into itself: corners are rounded to single precision
  bool winds_ = false;  // round its first corner more than once: it may cross itself at a corner
  std::vector<std::array<std::size_t, 3>> triangles_;
  std::string reason_;
};

}  // namespace viewgain::detail
