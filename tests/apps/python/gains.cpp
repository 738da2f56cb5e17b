// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What C++ makes of a map and poses, for comparing with Python: gains MAP POSES GAINS [REPEATS]
// POSES and GAINS hold bare doubles, 12 (three rows) and 1 a pose; prints the median seconds a
// batch.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <viewgain/viewgain.hpp>

int main(int count, char** arguments) {
  if (count < 4) return 2;
  const viewgain::GainEvaluator evaluator(
      viewgain::VoxelScene::build(viewgain::load_vdb(arguments[1])),
      viewgain::sensor_preset("sr4000"), {.model = viewgain::GainModel::paper});
  std::ifstream in(arguments[2], std::ios::binary);
  std::vector<viewgain::Pose> poses;
  for (viewgain::Pose pose; in.read(reinterpret_cast<char*>(pose.m.data()), sizeof(pose.m));) {
    poses.push_back(pose);
  }
  std::vector<viewgain::ViewGain> views(poses.size());
  std::vector<double> seconds;
  for (int i = 0; i < (count > 4 ? std::atoi(arguments[4]) : 1); ++i) {
    const auto begin = std::chrono::steady_clock::now();
    evaluator.evaluate(poses, views);
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::ofstream out(arguments[3], std::ios::binary);
  for (const viewgain::ViewGain& view : views) {
    out.write(reinterpret_cast<const char*>(&view.gain), sizeof(view.gain));
  }
  std::sort(seconds.begin(), seconds.end());
  std::printf("%.9f\n", seconds[seconds.size() / 2]);
  return out ? 0 : 1;
}
