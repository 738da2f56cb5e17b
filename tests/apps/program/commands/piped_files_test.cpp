// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Files that come from pipes, which can be read only once: --poses <(...).

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

// The reading end of a pipe that holds a file, and that programs started from here have open, too.
class Pipe {
 public:
  explicit Pipe(const std::string& bytes) {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    end_ = ends[0];
    EXPECT_GT(::fcntl(ends[1], F_SETPIPE_SZ, static_cast<int>(bytes.size())), 0);
    EXPECT_EQ(::write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    ::close(ends[1]);
  }
  ~Pipe() { ::close(end_); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  [[nodiscard]] std::string name() const { return "/dev/fd/" + std::to_string(end_); }

 private:
  int end_ = -1;
};

class PipedFiles : public test::ProgramTest {
 protected:
  PipedFiles() {
    make_small_run();
    write("poses.txt",
          "0 0 0 0.6 1 0 0 0\n1 0 0 0.5 1 0 0 0\n2 0.1 0 0.55 1 0 0 0\n3 0 0.1 0.5 1 0 0 0\n");
    write("costs.txt", "1e-5\n2e-5\n3e-5\n4e-5\n");
    write("obstacle.off",
          "OFF\n4 4 0\n0.4 0.4 -0.4\n0.5 0.4 -0.4\n0.4 0.5 -0.4\n0.4 0.4 -0.3\n"
          "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    write("reach.toml", "format = 1\n[[box]]\nmin = [-1.0, -1.0, -1.0]\nmax = [1.0, 1.0, 1.0]\n");
    write("score.toml", "map = \"run/map.vdb\"\nposes = \"sphere:50,0.6\"\njson = true\n");
    write("again.toml",
          "mesh = \"cube.off\"\nsensor = \"tof.toml\"\nvoxel = 0.0125\nsize = 0.2\nmax-views = 1\n"
          "pictures = false\njson = true\n");
    run_well({"simulate", "cube.off", "--poses", "orbit:2,0.6,27", "--sensor", "tof.toml", "--size",
              "0.2", "--place", "center", "--quiet", "--out", "frames"});
    const BeliefGrid grid = load_vdb(dir / "run/map.vdb");
    HazardConfig::Volume volume{VoxelBox::from_dims(grid.min_index(), grid.dims()), {}, 0.5F};
    volume.rates.assign(volume.box.volume(), 2.0F);
    save_hazard_vdb(volume, grid, dir / "rates.vdb");
  }

  static json without_times(json value) {
    if (value.is_object()) {
      for (const char* key :
           {"seconds", "settings", "out", "timing", "poses_per_second", "rays_per_second"})
        value.erase(key);
    }
    if (value.is_structured()) {
      for (json& part : value) part = without_times(std::move(part));
    }
    return value;
  }

  // What a call says, but for times and names.
  [[nodiscard]] json answer(const Strings& call) const {
    const test::ProgramResult result = run(call);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return without_times(json::parse(result.out, nullptr, false));
  }

  // The call with these files from pipes says what it says with the files themselves. Names whose
  // ending counts are links to a pipe.
  void expect_same(const Strings& call, const Strings& files) {
    Strings piped = call;
    std::vector<std::unique_ptr<Pipe>> pipes;
    for (const std::string& file : files) {
      pipes.push_back(std::make_unique<Pipe>(read(file)));
      std::string name = pipes.back()->name();
      if (!file.ends_with(".txt")) {
        const std::string link = "link" + std::to_string(pipes.size()) + "-" + file;
        fs::remove(dir / link);
        fs::create_symlink(name, dir / link);
        name = link;
      }
      const auto word = std::find(piped.begin(), piped.end(), file);
      ASSERT_NE(word, piped.end()) << file;
      *word = name;
    }
    const json expected = answer(call);
    EXPECT_FALSE(expected.is_discarded());
    EXPECT_EQ(answer(piped), expected) << call[0] << ' ' << files[0];
    ++cases;
  }

  int cases = 0;
};

TEST_F(PipedFiles, AreReadOnce) {
  expect_same({"next", "run/map.vdb", "--poses", "poses.txt", "--json"}, {"poses.txt"});
  expect_same({"next", "run/map.vdb", "--generator", "boundary", "--poses", "poses.txt", "--costs",
               "costs.txt", "--reach", "reach.toml", "--hazard", "rates.vdb", "--obstacle",
               "obstacle.off", "--sensor", "tof.toml", "--json", "--out", "next.txt"},
              {"poses.txt", "costs.txt", "reach.toml", "rates.vdb", "obstacle.off", "tof.toml"});
  expect_same({"score", "run/map.vdb", "--poses", "poses.txt", "--costs", "costs.txt", "--reach",
               "reach.toml", "--json", "--out", "scores.csv"},
              {"poses.txt", "costs.txt", "reach.toml"});
  expect_same({"score", "--config", "score.toml"}, {"score.toml"});
  expect_same({"reconstruct", "--config", "again.toml", "--out", "again"}, {"again.toml"});
  expect_same({"model",      "frames",       "--voxel",
               "0.0125",     "--workspace",  "-0.15,-0.15,-0.15,0.15,0.15,0.15",
               "--sensor",   "tof.toml",     "--poses",
               "poses.txt",  "--costs",      "costs.txt",
               "--obstacle", "obstacle.off", "--reach",
               "reach.toml", "--pictures",   "off",
               "--report",   "off",          "--quiet",
               "--json",     "--out",        "of_frames"},
              {"tof.toml", "poses.txt", "costs.txt", "obstacle.off", "reach.toml"});
  EXPECT_EQ(cases, 6);
}

}  // namespace
}  // namespace viewgain
