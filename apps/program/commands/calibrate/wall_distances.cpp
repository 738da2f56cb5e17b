// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/calibrate/wall_distances.hpp"

#include <cstddef>
#include <map>
#include <string_view>

#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

// The number of the frame of this name, with or without the image's ending.
std::map<std::string, std::size_t> numbers_of(const std::vector<fs::path>& images) {
  constexpr std::string_view kEnding = ".depth.png";
  std::map<std::string, std::size_t> numbers;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string name = images[i].filename().string();
    numbers[name] = i;
    numbers[name.substr(0, name.size() - kEnding.size())] = i;
  }
  return numbers;
}

}  // namespace

std::vector<std::optional<double>> read_wall_distances(const std::string& path,
                                                       const std::vector<fs::path>& images) {
  const std::map<std::string, std::size_t> numbers = numbers_of(images);
  std::vector<std::optional<double>> distances(images.size());
  const std::string bytes = file_bytes(path);
  std::size_t lines = 0, words = 0;
  for (LineReader line(path, bytes); line.next();) {
    if (line.words().empty() || line.words()[0].starts_with('#')) continue;
    if (lines++ == 0) words = line.words().size();
    if (line.words().size() != words || words > 2) {
      line.fail("needs a distance [m], or a frame's name and its distance, as all other lines");
    }
    std::size_t frame = lines - 1;
    if (words == 2) {
      const auto found = numbers.find(std::string(line.words()[0]));
      if (found == numbers.end()) {
        line.fail("there is no frame " + quoted(line.words()[0]) + " in the folder");
      }
      frame = found->second;
    } else if (frame >= distances.size()) {
      line.fail("is of no frame, the folder has " + std::to_string(distances.size()));
    }
    if (distances[frame]) line.fail("the frame has a distance already");
    const double distance = line.finite_number(words - 1);
    if (!(distance > 0)) line.fail("the distance " + short_text(distance) + " is not positive");
    distances[frame] = distance;
  }
  if (words != 2 && lines < distances.size()) {
    throw Error(ErrorCode::format, path + ": has " + std::to_string(lines) + " distances for " +
                                       std::to_string(distances.size()) +
                                       " frames; with names on its lines it may leave some out");
  }
  return distances;
}

}  // namespace viewgain::app
