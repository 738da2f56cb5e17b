#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""make_header_examples.py OUT.cpp HEADERS...: a test that runs the examples between @code and @endcode of headers."""
import pathlib
import re
import sys

GIVEN = """
using namespace viewgain;

// What the examples take as given.
struct Given {
  Sensor sensor = sensor_preset("sr4000");
  Box box{{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}};
  std::vector<Pose> poses = sphere_poses(50, 0.6);
  Pose T_world_camera = look_at({0.5, 0, 0}, {0, 0, 0});
  DepthFrame frame{sensor.camera.width, sensor.camera.height,
                   std::vector<float>(static_cast<std::size_t>(sensor.camera.width * sensor.camera.height), 0.45F)};
  std::vector<std::pair<DepthFrame, Pose>> frames{{frame, T_world_camera}, {frame, look_at({0, 0.5, 0}, {0, 0, 0})}};
  BeliefGrid grid{{.voxel_size = 0.01, .workspace = box}, sensor};
  FrameIntegrator integrator{sensor};
};
"""


def main():
    out = pathlib.Path(sys.argv[1])
    includes, tests = set(), ""
    for header in map(pathlib.Path, sys.argv[2:]):
        lines = header.read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines, 1):
            if line.strip() != "/// @code":
                continue
            end = next(i for i in range(number, len(lines)) if lines[i].strip() == "/// @endcode")
            code = "\n".join(re.sub(r"^\s*/// ?", "", text) for text in lines[number:end])
            name = f"{header.stem}_{number}"
            includes.add("#include <" + str(header).split("/include/", 1)[1] + ">")
            tests += (f"\nTEST(HeaderExamples, {name}) {{\n  Given given;\n  [[maybe_unused]] auto& [sensor, box, poses, "
                      f"T_world_camera, frame, frames, grid, integrator] = given;\n"
                      f'#line {number + 1} "{header}"\n{code}\n}}\n')
    own = ('// Examples show names that they do not use, and their own.\n#pragma GCC diagnostic ignored "-Wshadow"\n'
           '#pragma GCC diagnostic ignored "-Wunused-variable"\n')
    own += "#include <gtest/gtest.h>\n\n#include <utility>\n#include <vector>\n#include <viewgain/viewgain.hpp>\n"
    out.write_text(own + "\n".join(sorted(includes)) + "\n" + GIVEN + tests, encoding="utf-8")


if __name__ == "__main__":
    main()
