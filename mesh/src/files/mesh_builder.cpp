// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {

constexpr double kBeyond = 1e30;  // single precision has room for it

// Splits polygons in space into triangles that fill them: a fan of the first corner where that
// does, else by clipping ears. It is looked at along the axis nearest to its normal, so it need
// not be quite plane; it may touch itself, as one does whose holes are joined to its rim. Cost:
// linear for a fan, else quadratic.
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

namespace {

using Vector = std::array<double, 3>;

constexpr std::size_t kMostCorners = 10'000;  // of one that is no fan: some seconds

Vector cross_product(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Twice the area of a triangle, positive if it turns to the left.
template <typename Flat>
double turn_of(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// How far c lies to the left of the line from a to b; 0 if that has no length.
template <typename Flat>
double left_of(const Flat& a, const Flat& b, const Flat& c) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  return length > 0 ? turn_of(a, b, c) / length : 0;
}

}  // namespace

bool EarClipping::split() {
  triangles_.clear();
  const double twice_area = flatten();
  if (add_fan()) return true;
  triangles_.clear();
  if (corners_.size() > kMostCorners) {
    reason_ = "has reflex corners among more than " + std::to_string(kMostCorners);
    return false;
  }
  reason_ = "crosses itself";
  return twice_area > no_area_ && !winds_ && !crosses_itself() && clip_all();
}

// Drops the axis along which the normal is longest: what lies inside stays inside.
double EarClipping::flatten() {
  const Vector first = corners_.front();
  Vector normal{};
  double extent = 0;
  for (Vector& p : corners_) {
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] -= first[k];
      extent = std::max(extent, std::abs(p[k]));
    }
  }
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    const Vector n = cross_product(corners_[i - 1], corners_[i]);
    for (std::size_t k = 0; k < 3; ++k) normal[k] += n[k];
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(x, y);
  flat_.clear();
  for (const Vector& p : corners_) flat_.push_back({p[x], p[y]});
  no_area_ = 1e-12 * extent * extent;
  slack_ = 1e-7 * extent;
  return std::abs(normal[axis]);
}

// True if the fan of the first corner fills the polygon, or that is a line. It does not where the
// others go round the first one more than once.
bool EarClipping::add_fan() {
  bool turns_left = true, is_back = false, was_beyond = false;
  winds_ = false;
  for (std::size_t i = 2; i < flat_.size(); ++i) {
    triangles_.push_back({0, i - 1, i});
    const double side = turn_of(flat_[0], flat_[1], flat_[i]);
    turns_left = turns_left && turn_of(flat_[0], flat_[i - 1], flat_[i]) > no_area_;
    is_back = is_back || (was_beyond && side > no_area_);
    winds_ = winds_ || (was_beyond && left_of(flat_[0], flat_[1], flat_[i]) > slack_);
    was_beyond = was_beyond || side < 0;
  }
  winds_ = winds_ && turns_left;
  return (turns_left && !is_back) || !has_area();
}

bool EarClipping::has_area() const {
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    for (const double n : cross_product(corners_[i - 1], corners_[i])) {
      if (std::abs(n) > no_area_) return true;
    }
  }
  return false;
}

bool EarClipping::crosses_itself() const {
  const auto parts = [this](const Flat& a, const Flat& b, const Flat& c, const Flat& d) {
    const double left = left_of(a, b, c), right = left_of(a, b, d);
    return (left > slack_ && right < -slack_) || (left < -slack_ && right > slack_);
  };
  const std::size_t count = flat_.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 2; j < count; ++j) {
      const Flat &a = flat_[i], &b = flat_[i + 1], &c = flat_[j], &d = flat_[(j + 1) % count];
      if (parts(a, b, c, d) && parts(c, d, a, b)) return true;
    }
  }
  return false;
}

// Its height over the line between its neighbours.
double EarClipping::height_at(std::size_t corner) const {
  return left_of(flat_[after_[corner]], flat_[before_[corner]], flat_[corner]);
}

bool EarClipping::is_ear(std::size_t corner) const {
  const Flat &a = flat_[before_[corner]], &b = flat_[corner], &c = flat_[after_[corner]];
  if (!(turn_of(a, b, c) > no_area_)) return false;
  for (std::size_t i = after_[after_[corner]]; i != before_[corner]; i = after_[i]) {
    const Flat& p = flat_[i];
    if (p == a || p == b || p == c) continue;
    if (left_of(a, b, p) >= -slack_ && left_of(b, c, p) >= -slack_ && left_of(c, a, p) >= -slack_) {
      return false;
    }
  }
  return true;
}

void EarClipping::clip(std::size_t corner) {
  const std::size_t a = before_[corner], c = after_[corner];
  triangles_.push_back({a, corner, c});
  after_[a] = c;
  before_[c] = a;
  is_ear_[a] = is_ear(a) ? 1 : 0;
  is_ear_[c] = is_ear(c) ? 1 : 0;
}

bool EarClipping::clip_all() {
  const std::size_t count = flat_.size();
  before_.resize(count);
  after_.resize(count);
  is_ear_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    before_[i] = (i + count - 1) % count;
    after_[i] = (i + 1) % count;
  }
  for (std::size_t i = 0; i < count; ++i) is_ear_[i] = is_ear(i) ? 1 : 0;
  std::size_t at = 0;
  for (std::size_t left = count; left > 3; --left) {
    const auto find = [&](auto&& is_wanted) {
      for (std::size_t seen = 0; seen < left; ++seen, at = after_[at]) {
        if (is_wanted(at)) return true;
      }
      return false;
    };
    // Where no ear is left, a corner in the middle of an edge, or at a spike, has no area to lose.
    if (!find([this](std::size_t i) { return is_ear_[i] != 0; }) &&
        !find([this](std::size_t i) { return std::abs(height_at(i)) <= slack_; })) {
      return false;
    }
    clip(at);
    at = after_[at];
  }
  triangles_.push_back({before_[at], at, after_[at]});
  return height_at(at) >= -slack_;
}

void MeshBuilder::fail(std::size_t line, const std::string& what) const {
  throw Error(ErrorCode::format,
              name_ + (line > 0 ? ":" + std::to_string(line) : "") + ": " + what);
}

void MeshBuilder::add_vertex(const std::array<double, 3>& p, std::size_t line) {
  for (const double x : p) {
    if (std::abs(x) < kBeyond) continue;
    fail(line, "a coordinate of vertex " + std::to_string(vertices()) +
                   " is not finite, or 1e30 and more");
  }
  mesh_.vertices.push_back(p);
}

void MeshBuilder::add_corner(double index, std::size_t line) {
  if (!(index >= 0 && index < std::numeric_limits<std::uint32_t>::max())) {
    fail(line, "face " + std::to_string(faces_.size()) + " has an index out of range");
  }
  corners_.push_back(static_cast<std::uint32_t>(index));
}

TriangleMesh MeshBuilder::finish() && {
  split_faces();
  if (mesh_.triangles.empty()) fail(0, "the mesh has no faces");
  drop_unused();
  return std::move(mesh_);
}

void MeshBuilder::split_faces() {
  EarClipping polygon;
  std::size_t begin = 0;
  for (const Face& face : faces_) {
    const std::uint32_t* const corners = corners_.data() + begin;
    const std::size_t count = face.end - begin;
    begin = face.end;
    const auto number = [&] { return "face " + std::to_string(&face - faces_.data()); };
    polygon.clear();
    for (std::size_t i = 0; i < count; ++i) {
      if (corners[i] >= vertices()) {
        fail(face.line, number() + " has an index out of range, the file has " +
                            std::to_string(vertices()) + " vertices");
      }
      if (count > 3) polygon.add(mesh_.vertices[corners[i]]);
    }
    if (count == 3) mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
    if (count <= 3) continue;
    if (!polygon.split()) fail(face.line, number() + " " + polygon.reason());
    for (const auto& t : polygon.triangles()) {
      mesh_.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    }
  }
}

void MeshBuilder::drop_unused() {
  std::vector<std::uint32_t> place(vertices(), 0);
  for (const auto& t : mesh_.triangles) {
    for (const std::uint32_t corner : t) place[corner] = 1;
  }
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] == 0) continue;
    mesh_.vertices[used] = mesh_.vertices[i];
    place[i] = used++;
  }
  mesh_.vertices.resize(used);
  for (auto& t : mesh_.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
}

}  // namespace viewgain::detail
