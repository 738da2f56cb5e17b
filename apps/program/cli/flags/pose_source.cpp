// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/pose_source.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdio>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/support/columns/mapped_poses.hpp"
#include "viewgain/support/columns/part_reader.hpp"
#include "viewgain/support/mix64.hpp"

namespace viewgain::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

[[noreturn]] void refuse(const std::string& flag, const std::string& text,
                         const std::string& what) {
  throw Error(ErrorCode::invalid_argument, flag + " " + text + ": " + what);
}

// Generators know nothing of flags; a user does not know which value is meant without one.
template <typename Make>
std::vector<Pose> naming_the_flag(const std::string& flag, const std::string& text, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(error.code(), flag + " " + text + ": " + error.what());
  }
}

using CenteredGenerator = std::vector<Pose> (*)(std::size_t, double, const Eigen::Vector3d&);

std::vector<Pose> round_center(const std::string& flag, const std::string& text,
                               const Eigen::Vector3d& center, CenteredGenerator generator) {
  const std::vector<double> n = parse_numbers(flag, text, 2, 2);
  const std::size_t count = parse_count(flag, n[0]);
  return naming_the_flag(flag, text, [&] { return generator(count, n[1], center); });
}

std::vector<Pose> orbit(const std::string& text, const Eigen::Vector3d& center) {
  const std::vector<double> n = parse_numbers("--orbit", text, 3, 5);
  const std::size_t count = parse_count("--orbit", n[0]);
  const double start = n.size() > 3 ? n[3] * kDegree : 0.0;
  const std::optional<double> step =
      n.size() > 4 ? std::optional<double>(n[4] * kDegree) : std::nullopt;
  return naming_the_flag("--orbit", text, [&] {
    return orbit_poses(count, n[1], n[2] * kDegree, start, step, center);
  });
}

std::vector<Pose> shell(const std::string& text, const Eigen::Vector3d& center,
                        std::uint64_t seed) {
  const std::vector<double> n = parse_numbers("--shell", text, 3, 3);
  const std::size_t count = parse_count("--shell", n[0]);
  return naming_the_flag("--shell", text,
                         [&] { return shell_poses(count, n[1], n[2], seed, center); });
}

std::uint64_t hash_of(const Pose& pose) {
  std::uint64_t hash = 0;
  for (const double number : pose.m) hash = mix64(hash ^ std::bit_cast<std::uint64_t>(number));
  return hash;
}

// hash(i): of row i.
template <typename Hash>
std::string hash_of_rows(std::size_t rows, const Hash& hash) {
  constexpr std::size_t kMost = 4096;
  const std::size_t count = std::min(rows, kMost);
  std::uint64_t all = mix64(rows);
  for (std::size_t i = 0; i < count; ++i) {
    all = mix64(all ^ hash(count == 1 ? 0 : i * (rows - 1) / (count - 1)));
  }
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(all));
  return digits.data();
}

PoseSource mapped_poses(const std::string& file, const RowSelection& selection) {
  const MappedPoses mapped(file);
  PoseSource source;
  source.total = mapped.size();
  source.rows = selection.of(mapped.size());
  source.hash = hash_of_rows(mapped.size(), [&](std::size_t row) { return mapped.hash(row); });
  source.poses.reserve(source.rows.end - source.rows.begin);
  for (std::size_t row = source.rows.begin; row < source.rows.end; ++row) {
    bool mended = false;
    source.poses.push_back(mapped.at(row, mended));
    source.orthonormalized += mended ? 1 : 0;
  }
  return source;
}

std::vector<Pose> set_of_poses(const PoseOptions& options, std::uint64_t seed) {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  if (!options.center.empty()) center = parse_point("--center", options.center);
  if (!options.orbit.empty()) return orbit(options.orbit, center);
  if (!options.sphere.empty())
    return round_center("--sphere", options.sphere, center, sphere_poses);
  if (!options.rings.empty()) {
    return round_center("--rings", options.rings, center, literature_ring_poses);
  }
  if (!options.shell.empty()) return shell(options.shell, center, seed);
  return round_center("--dome", options.dome, center, dome_poses);
}

// "3/8" or "30:80".
std::pair<std::uint64_t, std::uint64_t> two_counts(const std::string& flag,
                                                   const std::string& value, char separator) {
  std::pair<std::uint64_t, std::uint64_t> found;
  const char* const end = value.data() + value.size();
  const auto first = std::from_chars(value.data(), end, found.first);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == separator) {
    const auto second = std::from_chars(first.ptr + 1, end, found.second);
    if (second.ec == std::errc() && second.ptr == end) return found;
  }
  refuse(flag, value, separator == '/' ? "must be i/n, i from 0" : "must be a:b, rows from 0");
}

}  // namespace

RowSelection RowSelection::parse(const std::string& shard, const std::string& rows) {
  RowSelection selection;
  if (!shard.empty()) {
    std::tie(selection.first_, selection.second_) = two_counts("--shard", shard, '/');
    constexpr std::uint64_t kMost = 10'000'000;
    if (selection.first_ >= selection.second_ || selection.second_ > kMost) {
      refuse("--shard", shard, "i must be below n, from 0, and n at most 10,000,000");
    }
    selection.text_ = "--shard " + shard;
    selection.is_shard_ = true;
  } else if (!rows.empty()) {
    std::tie(selection.first_, selection.second_) = two_counts("--rows", rows, ':');
    if (selection.first_ >= selection.second_) refuse("--rows", rows, "a must be below b");
    selection.text_ = "--rows " + rows;
  }
  return selection;
}

RowRange RowSelection::of(std::uint64_t poses) const {
  if (is_all()) return {0, poses};
  if (is_shard_) return {poses * first_ / second_, poses * (first_ + 1) / second_};
  if (second_ > poses) {
    throw Error(ErrorCode::invalid_argument,
                text_ + ": there are " + std::to_string(poses) + " poses");
  }
  return {first_, second_};
}

PoseSource make_poses(const PoseOptions& options, std::uint64_t seed,
                      const RowSelection& selection) {
  if (!options.file.empty() && !options.center.empty()) {
    refuse("--center", options.center, "goes with sets of poses, not with --poses");
  }
  if (is_npy(options.file)) return mapped_poses(options.file, selection);
  PoseSource source;
  source.poses = options.file.empty() ? set_of_poses(options, seed) : std::vector<Pose>();
  if (!options.file.empty()) {
    PoseList list = read_tum(options.file);
    source.poses = std::move(list.poses);
    source.orthonormalized = list.orthonormalized;
  }
  source.total = source.poses.size();
  source.rows = selection.of(source.total);
  source.hash =
      hash_of_rows(source.total, [&](std::size_t row) { return hash_of(source.poses[row]); });
  if (!selection.is_all()) {
    const auto begin = source.poses.begin();
    source.poses = std::vector<Pose>(begin + static_cast<std::ptrdiff_t>(source.rows.begin),
                                     begin + static_cast<std::ptrdiff_t>(source.rows.end));
  }
  return source;
}

}  // namespace viewgain::app
