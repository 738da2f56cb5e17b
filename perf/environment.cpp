// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "environment.hpp"

#include <Eigen/Core>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "commit.hpp"
#include "measure.hpp"
#include "viewgain/support/isa.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {

void add_environment(nlohmann::ordered_json& json, int num_threads) {
  json["threads"] = num_threads;
  json["cpu"] = cpu_name();
  json["isa"] = isa_name(select_isa());
  json["compiler"] = VIEWGAIN_COMPILER;
  json["build_type"] = VIEWGAIN_BUILD_TYPE;
  const std::string world = std::to_string(EIGEN_WORLD_VERSION);
  json["versions"] = {{"embree", VIEWGAIN_EMBREE_VERSION},
                      {"openvdb", VIEWGAIN_OPENVDB_VERSION},
                      {"eigen", world + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
                                    std::to_string(EIGEN_MINOR_VERSION)},
                      {"octomap", VIEWGAIN_OCTOMAP_VERSION},
                      {"cgal", VIEWGAIN_CGAL_VERSION}};
  json["commit"] = VIEWGAIN_COMMIT;
}

int run_environment(int num_threads) {
  nlohmann::ordered_json json;
  add_environment(json, ThreadPool(num_threads).num_threads());
  std::printf("%s\n", json.dump(2).c_str());
  return 0;
}

}  // namespace viewgain::bench
