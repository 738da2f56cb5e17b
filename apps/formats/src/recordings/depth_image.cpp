// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/depth_image.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "png_bytes.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr std::uint16_t kFullPixel = 65535;
constexpr std::uint32_t kMostSide = 16384;

template <typename Word>
Word word_at(const char* bytes, bool is_big_endian) {
  Word value{};
  std::memcpy(&value, bytes, sizeof value);
  if (!is_big_endian) return value;
  if constexpr (sizeof(Word) == 2) return __builtin_bswap16(value);
  if constexpr (sizeof(Word) == 4) return __builtin_bswap32(value);
}

float depth_of_units(std::uint16_t value, double unit) {
  return value == kFullPixel ? 0.0F : static_cast<float>(value * unit);
}

DepthImage decode_png(const DepthMessage& message, double unit) {
  const GrayImage image = gray_image_of_png(message.data);
  DepthImage depth{image.width, image.height, {}};
  depth.z.reserve(image.pixels.size());
  const bool is_float = message.encoding == "32FC1";
  for (const std::uint16_t value : image.pixels) {
    if (!is_float) {
      depth.z.push_back(depth_of_units(value, unit));
      continue;
    }
    const float inverse = static_cast<float>(value) - message.inverse[1];
    const float z = value == 0 ? 0.0F : message.inverse[0] / inverse;
    depth.z.push_back(std::isfinite(z) ? z : 0.0F);
  }
  return depth;
}

// Mean difference between neighbours, relative to the mean depth; NaN for under 16 pairs.
double roughness(const DepthImage& depth) {
  double steps = 0, sum = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 1; i < depth.z.size(); ++i) {
    const double a = depth.z[i - 1], b = depth.z[i];
    if (i % static_cast<std::size_t>(depth.width) == 0) continue;
    if (!(a > 0 && b > 0) || std::isinf(a) || std::isinf(b)) continue;
    steps += std::abs(a - b), sum += a, ++pairs;
  }
  return pairs < 16 ? std::numeric_limits<double>::quiet_NaN() : steps / sum;
}

}  // namespace

int depth_likelihood(const std::string& encoding) {
  if (encoding == "16UC1" || encoding == "32FC1") return 2;
  return encoding == "mono16" ? 1 : 0;
}

DepthImage decode_depth(const DepthMessage& message, double unit) {
  const auto fail = [](const std::string& what) -> void { throw Error(ErrorCode::format, what); };
  if (depth_likelihood(message.encoding) == 0) {
    fail("the encoding " + viewgain::quoted(message.encoding) +
         " is not supported for depth; supported encodings: 16UC1, 32FC1, mono16");
  }
  if (message.is_compressed) return decode_png(message, unit);
  const std::size_t bytes = message.encoding == "32FC1" ? 4 : 2;
  const std::uint64_t width = message.width, height = message.height, step = message.step;
  if (width == 0 || height == 0 || width > kMostSide || height > kMostSide ||
      step < width * bytes || (height - 1) * step + width * bytes > message.data.size()) {
    fail("the image is inconsistent: it has " + std::to_string(width) + "x" +
         std::to_string(height) + " px, rows of " + std::to_string(step) + " bytes and " +
         std::to_string(message.data.size()) + " bytes");
  }
  DepthImage depth{static_cast<int>(width), static_cast<int>(height), {}};
  depth.z.reserve(width * height);
  for (std::size_t v = 0; v < height; ++v) {
    const char* row = message.data.data() + v * step;
    for (std::size_t u = 0; u < width; ++u, row += bytes) {
      if (bytes == 2) {
        depth.z.push_back(depth_of_units(word_at<std::uint16_t>(row, message.is_big_endian), unit));
      } else {
        depth.z.push_back(std::bit_cast<float>(word_at<std::uint32_t>(row, message.is_big_endian)));
      }
    }
  }
  return depth;
}

std::optional<bool> is_wrong_byte_order(const DepthMessage& message) {
  if (message.is_compressed) return false;
  DepthMessage swapped = message;
  swapped.is_big_endian = !message.is_big_endian;
  const double as_said = roughness(decode_depth(message)), other = roughness(decode_depth(swapped));
  if (!std::isfinite(as_said)) return std::nullopt;
  return std::isfinite(other) && as_said > 0.004 && as_said > 4 * other;
}

GrayImage gray_image(const DepthImage& depth, double unit) {
  GrayImage image{depth.width, depth.height, {}};
  image.pixels.reserve(depth.z.size());
  for (const float z : depth.z) {
    const double units = std::round(static_cast<double>(z) / unit);
    if (std::isinf(z) && z > 0) {
      image.pixels.push_back(kFullPixel);
    } else {
      image.pixels.push_back(units > 0 && units < kFullPixel ? static_cast<std::uint16_t>(units)
                                                             : std::uint16_t{0});
    }
  }
  return image;
}

}  // namespace viewgain
