// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/png.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "png_bytes.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/file_names.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kSizeEnd = 24;  // of a file's signature and size

// Holds everything that must survive libpng's longjmp, outside the functions that the longjmp
// leaves.
struct PngState {
  std::string bytes;
  std::size_t position = 0;
  std::string message;
  std::vector<png_bytep> rows;
};

void on_error(png_structp png, png_const_charp message) {
  static_cast<PngState*>(png_get_error_ptr(png))->message = message;
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep out, std::size_t count) {
  auto* state = static_cast<PngState*>(png_get_io_ptr(png));
  if (count > state->bytes.size() - state->position) png_error(png, "the file ends early");
  std::memcpy(out, state->bytes.data() + state->position, count);
  state->position += count;
}

void write_bytes(png_structp png, png_bytep data, std::size_t count) {
  static_cast<PngState*>(png_get_io_ptr(png))
      ->bytes.append(reinterpret_cast<const char*>(data), count);
}

void flush_nothing(png_structp) {}

// If libpng fails, its longjmp leaves the functions below; they then return false with a message in
// `state`. They must not contain objects with destructors; their callers may.

// The required format: a grey image of one of these depths.
struct Wanted {
  int least_bits, most_bits;
  const char* refusal;
};

// Sets up the image's rows for its size; refuses by a message in `state`. snprintf into a fixed
// buffer avoids temporaries.
template <typename Image>
bool set_rows(png_structp png, png_infop info, PngState& state, Image& image) {
  const png_uint_32 columns = png_get_image_width(png, info);
  const png_uint_32 rows = png_get_image_height(png, info);
  if (columns != static_cast<png_uint_32>(image.width) ||
      rows != static_cast<png_uint_32>(image.height)) {
    std::snprintf(state.message.data(), state.message.size(),
                  "the image has %lux%lu pixels, not %dx%d", static_cast<unsigned long>(columns),
                  static_cast<unsigned long>(rows), image.width, image.height);
    return false;
  }
  image.pixels.resize(std::size_t{columns} * rows);
  for (std::size_t v = 0; v < rows; ++v) {
    state.rows.push_back(reinterpret_cast<png_bytep>(image.pixels.data() + v * columns));
  }
  return true;
}

template <typename Image>
bool decode(png_structp png, png_infop info, PngState& state, const Wanted& wanted, Image& image) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &state, read_bytes);
  png_read_info(png, info);
  const int bits = png_get_bit_depth(png, info);
  if (bits < wanted.least_bits || bits > wanted.most_bits ||
      png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY) {
    png_error(png, wanted.refusal);
  }
  if (!set_rows(png, info, state, image)) return false;
  if (bits == 16) png_set_swap(png);   // PNG is big-endian, this machine is not
  if (bits < 8) png_set_packing(png);  // one byte per pixel
  (void)png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, state.rows.data());
  png_read_end(png, nullptr);
  return true;
}

bool encode(png_structp png, png_infop info, PngState& state, int width, int height, int bit_depth,
            int color_type) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &state, write_bytes, flush_nothing);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
               bit_depth, color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (bit_depth == 16) png_set_swap(png);
  png_write_image(png, state.rows.data());
  png_write_end(png, info);
  return true;
}

[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& path, const std::string& what) {
  throw Error(code, path.string() + ": " + what);
}

// Writes a PNG of `channels` values per pixel.
template <typename Value>
std::string encoded(int width, int height, int color_type, const std::vector<Value>& pixels,
                    std::size_t channels) {
  constexpr int bit_depth = 8 * sizeof(Value);
  const std::size_t row = channels * static_cast<std::size_t>(std::max(width, 0));
  if (width <= 0 || height <= 0 || pixels.size() != row * static_cast<std::size_t>(height)) {
    refuse("the image has " + std::to_string(width) + " x " + std::to_string(height) + " px, but " +
           std::to_string(pixels.size()) + " values");
  }
  PngState state;
  // libpng takes rows as non-const but does not write to them.
  auto* first = reinterpret_cast<png_bytep>(const_cast<Value*>(pixels.data()));
  for (int v = 0; v < height; ++v) {
    state.rows.push_back(first + static_cast<std::size_t>(v) * row * sizeof(Value));
  }
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const bool ok = info != nullptr && encode(png, info, state, width, height, bit_depth, color_type);
  png_destroy_write_struct(&png, &info);
  if (!ok) throw Error(ErrorCode::io, "cannot encode the image: " + state.message);
  return std::move(state.bytes);
}

// Checks the image; messages name the file.
template <typename Value>
void write_image(const std::filesystem::path& path, int width, int height, int color_type,
                 const std::vector<Value>& pixels, std::size_t channels) {
  require_ending(path, "a picture", {".png"});
  std::string bytes;
  try {
    bytes = encoded(width, height, color_type, pixels, channels);
  } catch (const Error& error) {
    fail(error.code(), path, error.what());
  }
  write_file_atomically(path, bytes);
}

// Reads an image of the size of `image` from bytes; `name` is used in messages.
template <typename Image>
Image decoded(std::string bytes, const std::filesystem::path& name, const Wanted& wanted,
              Image image) {
  PngState state;
  state.bytes = std::move(bytes);
  state.message.resize(160);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, on_error, on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const bool ok = info != nullptr && decode(png, info, state, wanted, image);
  png_destroy_read_struct(&png, &info, nullptr);
  if (!ok) {
    fail(ErrorCode::format, name,
         "the image cannot be read: " + std::string(state.message.c_str()));
  }
  return image;
}

template <typename Image>
Image read_image(const std::filesystem::path& path, const Wanted& wanted, Image image) {
  if (image.width <= 0 || image.height <= 0) {
    fail(ErrorCode::invalid_argument, path,
         "the image size must be positive, not " + std::to_string(image.width) + " x " +
             std::to_string(image.height) + " px");
  }
  return decoded(folder_file_bytes(path), path, wanted, std::move(image));
}

// Width and height in a file's first bytes.
std::array<int, 2> size_in(const std::filesystem::path& path, std::string_view head) {
  constexpr std::string_view kBegin("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  const auto number = [&head](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
      value = value << 8U | static_cast<unsigned char>(head[i]);
    }
    return value;
  };
  constexpr std::uint32_t kMost = std::numeric_limits<std::int32_t>::max();
  if (head.size() < kSizeEnd || !head.starts_with(kBegin) || number(kBegin.size()) > kMost ||
      number(kBegin.size() + 4) > kMost) {
    fail(ErrorCode::format, path, "the image cannot be read: it is not a PNG file");
  }
  return {static_cast<int>(number(kBegin.size())), static_cast<int>(number(kBegin.size() + 4))};
}

constexpr Wanted kGray16{16, 16, "it is not a 16-bit grayscale image"};

}  // namespace

GrayImage read_gray_png(const std::filesystem::path& path, int width, int height) {
  return read_image<GrayImage>(path, kGray16, {width, height, {}});
}

GrayImage gray_image_of_png(std::string_view bytes) {
  const std::filesystem::path name = "PNG";
  const auto [width, height] = size_in(name, bytes);
  constexpr std::int64_t kMostPixels = std::int64_t{1} << 24U;
  if (width == 0 || height == 0 || std::int64_t{width} * height > kMostPixels) {
    fail(ErrorCode::format, name,
         "the image has " + std::to_string(width) + " x " + std::to_string(height) +
             " px; it must have 1 to 2^24 pixels");
  }
  return decoded<GrayImage>(std::string(bytes), name, kGray16, {width, height, {}});
}

Gray8Image read_gray8_png(const std::filesystem::path& path, int width, int height) {
  constexpr Wanted kWanted{1, 8, "it is not a grayscale image of 1 to 8 bits"};
  return read_image<Gray8Image>(path, kWanted, {width, height, {}});
}

std::array<int, 2> png_size(const std::filesystem::path& path) {
  return size_in(path, file_head(path, kSizeEnd));
}

void write_png(const std::filesystem::path& path, const GrayImage& image) {
  write_image(path, image.width, image.height, PNG_COLOR_TYPE_GRAY, image.pixels, 1);
}

void write_png(const std::filesystem::path& path, const RgbImage& image) {
  write_image(path, image.width, image.height, PNG_COLOR_TYPE_RGB, image.pixels, 3);
}

void write_png(const std::filesystem::path& path, const Gray8Image& image) {
  write_image(path, image.width, image.height, PNG_COLOR_TYPE_GRAY, image.pixels, 1);
}

}  // namespace viewgain
