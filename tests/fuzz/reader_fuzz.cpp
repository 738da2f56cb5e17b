// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// libFuzzer for what the environment names as VIEWGAIN_FUZZED: a reader of readers.cpp, which reads
// its input or throws Error, or calls of C. With --seeds FOLDER it writes the readers' good files
// there to begin with, a folder each.

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/files/mesh_dialects.hpp"
#include "readers/readers.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::test {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<const char*, std::size_t (*)(std::string_view)>, 3> kCalls{
    {{"c_calls", c_calls}, {"scorer_calls", scorer_calls}, {"map.vdb", vdb_maps}}};

void write_seeds(const fs::path& seeds) {
  const auto write = [&](const std::string& reader, const std::string& name,
                         const std::string& bytes) {
    fs::create_directories(seeds / reader);
    std::ofstream(seeds / reader / name, std::ios::binary) << bytes;
  };
  for (const Reader& reader : all_readers()) {
    const TemporaryFolder folder;
    reader.write(folder);
    for (std::size_t i = 0; i < reader.damaged.size(); ++i) {
      const std::string which(reader.damaged.size() > 1 ? 1 : 0, static_cast<char>(i));
      write(reader.name, std::to_string(i), which + read_all(folder.path() / reader.damaged[i]));
    }
  }
  for (const MeshDialect& row : mesh_dialects()) {
    const std::string reader = "mesh" + fs::path(row.file).extension().string();
    if (fs::exists(seeds / reader)) write(reader, row.file, row.bytes);
  }
  for (const char* calls : {"c_calls", "scorer_calls"})
    write(calls, "0", std::string(200, '\x01'));
  const std::vector<std::string> maps = vdb_seeds();
  for (std::size_t i = 0; i < maps.size(); ++i) write("map.vdb", std::to_string(i), maps[i]);
}

std::string fuzzed() { return std::getenv("VIEWGAIN_FUZZED"); }

// What takes the bytes for calls, or null: a reader takes them for a file.
auto fuzzed_calls() {
  for (const auto& [name, calls] : kCalls) {
    if (fuzzed() == name) return calls;
  }
  return decltype(kCalls.front().second)(nullptr);
}

const Reader& the_reader() {
  static const std::vector<Reader> all = all_readers();
  for (const Reader& reader : all) {
    if (reader.name == fuzzed()) return reader;
  }
  throw std::runtime_error("no reader " + fuzzed());
}

/// Of each chunk of a PNG: else libpng would look no further.
void mend_checksums(std::uint8_t* data, std::size_t size) {
  for (std::size_t at = 8; at + 12 <= size;) {
    std::size_t length = 0;
    for (std::size_t k = at; k < at + 4; ++k) length = length << 8U | data[k];
    if (length > size - at - 12) return;
    const uLong sum = crc32(0, data + at + 4, static_cast<uInt>(length + 4));
    at += 12 + length;
    for (unsigned k = 1; k <= 4; ++k)
      data[at - k] = static_cast<std::uint8_t>(sum >> (8 * (k - 1)));
  }
}

}  // namespace
}  // namespace viewgain::test

using namespace viewgain::test;

// OpenVDB's reader leaves nodes behind when it throws.
extern "C" const char* __lsan_default_suppressions() { return "leak:libopenvdb"; }

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  if (*count != 3 || std::string_view((*arguments)[1]) != "--seeds") return 0;
  write_seeds((*arguments)[2]);
  std::exit(0);
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned) {
  size = LLVMFuzzerMutate(data, size, most);
  if (fuzzed_calls() != nullptr) return size;
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (!damaged_name(the_reader(), bytes).ends_with(".png")) return size;
  mend_checksums(data + (size - bytes.size()), bytes.size());
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (const auto calls = fuzzed_calls()) return calls(bytes), 0;
  static const TemporaryFolder folder;
  static const bool is_first = (the_reader().write(folder), true);
  (void)is_first;
  try {
    read_in_place(the_reader(), folder, bytes);
  } catch (const viewgain::Error&) {
  }
  return 0;
}
