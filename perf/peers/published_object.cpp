// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "published_object.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/formats/cloud_io.hpp"

namespace viewgain::bench {
namespace {

constexpr std::size_t kMostViews = 1'000'000;

/// Lines of numbers of a text file; its errors name file and line.
class NumberLines {
 public:
  explicit NumberLines(const std::filesystem::path& path) : path_(path), file_(path) {
    if (!file_) throw Error(ErrorCode::io, path.string().append(": cannot be read"));
  }

  /// The next line, of exactly N finite numbers.
  template <std::size_t N>
  std::array<double, N> next(const char* what) {
    std::string line;
    ++number_;
    std::getline(file_, line);
    std::istringstream words(line);
    std::array<double, N> values{};
    for (double& value : values) {
      if (!(words >> value) || !std::isfinite(value)) fail(what);
    }
    std::string more;
    if (words >> more) fail(what);
    return values;
  }

  Eigen::Vector3d next_point(const char* what) {
    const auto p = next<3>(what);
    return {p[0], p[1], p[2]};
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::format, path_.string()
                                       .append(":")
                                       .append(std::to_string(number_))
                                       .append(": is not ")
                                       .append(what));
  }

 private:
  std::filesystem::path path_;
  std::ifstream file_;
  int number_ = 0;
};

std::size_t next_count(NumberLines& lines) {
  constexpr const char* kWhat = "a number of views, 1 to 1000000";
  const double count = lines.next<1>(kWhat)[0];
  if (!(count >= 1 && count <= kMostViews && count == std::floor(count))) lines.fail(kWhat);
  return static_cast<std::size_t>(count);
}

std::vector<Eigen::Vector3d> next_positions(NumberLines& lines, std::size_t count) {
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t i = 0; i < count; ++i) {
    positions.push_back(lines.next_point("a position, x y z"));
  }
  return positions;
}

double largest_coordinate(const std::vector<Eigen::Vector3d>& points) {
  double largest = 0;
  for (const Eigen::Vector3d& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

}  // namespace

double predicted_size(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& center,
                      double aim) {
  constexpr double kLeastChange = 0.001;
  double low = 0;
  double high = 0;
  for (const Eigen::Vector3d& p : points) high = std::max(high, (p - center).norm());
  double before = -1;
  while (true) {
    const double middle = 0.5 * (low + high);
    const auto inside = std::count_if(points.begin(), points.end(), [&](const auto& p) {
      return (p - center).cwiseAbs().maxCoeff() <= middle;
    });
    const double share = static_cast<double>(inside) / static_cast<double>(points.size());
    if (std::abs(before - share) < kLeastChange) return 1.2 * middle;
    before = share;
    (share > aim ? high : low) = middle;
  }
}

PublishedObject read_published_object(const std::filesystem::path& folder) {
  const std::filesystem::path cloud_path = folder / "3d_models" / "Armadillo.pcd";
  const std::filesystem::path views_path = folder / "3d_models" / "Armadillo.txt";
  PublishedObject object;
  for (const auto& p : load_cloud(cloud_path).points) object.points.emplace_back(p[0], p[1], p[2]);
  const bool all_finite = std::all_of(object.points.begin(), object.points.end(),
                                      [](const auto& p) { return p.allFinite(); });
  if (object.points.empty() || !all_finite) {
    throw Error(ErrorCode::format,
                cloud_path.string().append(": needs points, and all of them finite"));
  }
  const double unit = largest_coordinate(object.points) >= 10 ? 1e-3 : 1.0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (Eigen::Vector3d& p : object.points) center += p *= unit;
  center /= static_cast<double>(object.points.size());
  const double size = predicted_size(object.points, center, 0.92);
  if (size > 0.1) {
    for (Eigen::Vector3d& p : object.points) p *= 0.1 / size;
  }
  NumberLines lines(views_path);
  const std::size_t count = next_count(lines);
  object.center = lines.next_point("the object's centre, x y z");
  object.size = lines.next<1>("the object's size")[0];
  if (!(object.size > 0)) lines.fail("a positive size");
  object.eyes = next_positions(lines, count);
  return object;
}

std::vector<Eigen::Vector3d> read_view_space(const std::filesystem::path& path) {
  NumberLines lines(path);
  const std::size_t count = next_count(lines);
  return next_positions(lines, count);
}

}  // namespace viewgain::bench
