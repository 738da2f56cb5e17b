// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/temporary_folder.hpp"

namespace viewgain::test {

/// Good files below a folder, those of them that are to be damaged, and what reads them.
struct Reader {
  std::string name;
  std::function<void(const TemporaryFolder&)> write;
  std::vector<std::string> damaged;
  std::function<void(const std::filesystem::path&)> read;
  std::size_t one_in = 1;  ///< of so many cuts and changes is tried, where reading takes long
};

/// All readers of foreign bytes but OpenVDB's.
[[nodiscard]] std::vector<Reader> all_readers();

/// Which of its files an input of the fuzzers stands for: where there are several, its first byte
/// says, and is taken off.
[[nodiscard]] std::string damaged_name(const Reader& reader, std::string_view& bytes);

/// Reads it in the place of that file, which is good again afterwards. Throws what the reader
/// throws.
void read_in_place(const Reader& reader, const TemporaryFolder& folder, std::string_view bytes);

/// Calls the C interface as the bytes say: which call, which objects, which numbers; objects are
/// made, used and released in any order. Returns how many calls succeeded; throws std::logic_error
/// where a status is a defect of the library, or what came back cannot be.
std::size_t c_calls(std::string_view bytes);
/// The same of a scorer's calls.
std::size_t scorer_calls(std::string_view bytes);

/// Reads the bytes behind the first one, which says by what and whether a seal that fits is put
/// behind them, as a .vdb map. Returns whether it was one; throws what is no Error.
std::size_t vdb_maps(std::string_view bytes);
/// Good ones.
std::vector<std::string> vdb_seeds();

}  // namespace viewgain::test
