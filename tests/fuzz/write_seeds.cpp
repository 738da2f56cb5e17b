// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// write_seeds FOLDER: the mesh dialects as files, FOLDER/off and so on, for the fuzzers to begin
// with.

#include <cctype>
#include <filesystem>
#include <fstream>

#include "mesh/files/mesh_dialects.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  for (const auto& row : viewgain::test::mesh_dialects()) {
    std::string ending = row.file.substr(row.file.rfind('.') + 1);
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto folder = std::filesystem::path(argv[1]) / ending;
    std::filesystem::create_directories(folder);
    std::ofstream(folder / row.file, std::ios::binary) << row.bytes;
  }
}
