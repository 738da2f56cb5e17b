// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/unpack.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

#include "recordings/input_file.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

// The remaining input, and the remaining room for output.
struct Buffers {
  const char* in;
  std::size_t in_left;
  char* out;
  std::size_t out_left;
};

enum class Step : std::uint8_t { more, end, damaged };

// `step` reads and writes what it can and moves the buffers' ends.
template <typename StepFunction>
std::string unpack_by(StepFunction step, std::string_view packed, std::uint64_t size,
                      std::string& out) {
  constexpr std::size_t kFirstRoom = std::size_t{1} << 20U;
  std::size_t made = 0, used = 0;
  while (true) {
    if (made == out.size()) {
      out.resize(std::min<std::uint64_t>(size + 1, std::max(kFirstRoom, 2 * made)));
    }
    Buffers buffers{packed.data() + used, packed.size() - used, out.data() + made,
                    out.size() - made};
    const Step result = step(buffers);
    const std::size_t newly_made = out.size() - made - buffers.out_left;
    const std::size_t newly_used = packed.size() - used - buffers.in_left;
    made += newly_made, used += newly_used;
    std::string why;
    if (made > size) {
      why = "it has more bytes than it declares";
    } else if (result == Step::damaged) {
      why = "the packed bytes are damaged";
    } else if (result == Step::end && used == packed.size()) {
      if (made < size) why = "it has fewer bytes than it declares";
    } else if (newly_made == 0 && newly_used == 0) {
      why = "the packed bytes end early";
    } else {
      continue;
    }
    out.resize(std::min<std::uint64_t>(made, size));
    return why;
  }
}

template <typename Context>
Context* or_bad_alloc(Context* context) {
  if (context == nullptr) throw std::bad_alloc();
  return context;
}

std::string unpack_zstd(std::string_view packed, std::uint64_t size, std::string& out) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(
      or_bad_alloc(ZSTD_createDStream()), &ZSTD_freeDStream);
  return unpack_by(
      [&](Buffers& b) {
        ZSTD_inBuffer in{b.in, b.in_left, 0};
        ZSTD_outBuffer to{b.out, b.out_left, 0};
        const std::size_t result = ZSTD_decompressStream(stream.get(), &to, &in);
        b.in_left -= in.pos, b.out_left -= to.pos;
        if (ZSTD_isError(result) != 0) return Step::damaged;
        return result == 0 ? Step::end : Step::more;
      },
      packed, size, out);
}

std::string unpack_lz4(std::string_view packed, std::uint64_t size, std::string& out) {
  LZ4F_dctx* made = nullptr;
  (void)LZ4F_createDecompressionContext(&made, LZ4F_VERSION);
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      or_bad_alloc(made), &LZ4F_freeDecompressionContext);
  return unpack_by(
      [&](Buffers& b) {
        std::size_t in = b.in_left, to = b.out_left;
        const std::size_t result = LZ4F_decompress(context.get(), b.out, &to, b.in, &in, nullptr);
        if (LZ4F_isError(result) != 0) return Step::damaged;
        b.in_left -= in, b.out_left -= to;
        return result == 0 ? Step::end : Step::more;
      },
      packed, size, out);
}

std::string unpack_bz2(std::string_view packed, std::uint64_t size, std::string& out) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> freed(&stream,
                                                                         &BZ2_bzDecompressEnd);
  return unpack_by(
      [&](Buffers& b) {
        stream.next_in = const_cast<char*>(b.in);  // not written to
        stream.next_out = b.out;
        stream.avail_in = static_cast<unsigned>(b.in_left);
        stream.avail_out = static_cast<unsigned>(b.out_left);
        const int result = BZ2_bzDecompress(&stream);
        b.in_left = stream.avail_in, b.out_left = stream.avail_out;
        if (result == BZ_STREAM_END) return Step::end;
        return result == BZ_OK ? Step::more : Step::damaged;
      },
      packed, size, out);
}

}  // namespace

std::string unpack(std::string_view packing, std::string_view packed, std::uint64_t size,
                   std::string& out) {
  if (size > kMostRecordBytes) {
    throw Error(ErrorCode::format, "the chunk has " + std::to_string(size) +
                                       " bytes; the maximum is " +
                                       std::to_string(kMostRecordBytes));
  }
  if (packing.empty() || packing == "none") {
    out.assign(packed);
    return out.size() < size ? "it has fewer bytes than it declares" : "";
  }
  out.clear();
  if (packing == "zstd") return unpack_zstd(packed, size, out);
  if (packing == "lz4") return unpack_lz4(packed, size, out);
  if (packing == "bz2") return unpack_bz2(packed, size, out);
  throw Error(ErrorCode::format, "the chunk has the unknown compression '" +
                                     std::string(packing.substr(0, 32)) +
                                     "'; supported compressions: zstd, lz4, bz2, none");
}

}  // namespace viewgain
