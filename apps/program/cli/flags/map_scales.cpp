// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/map_scales.hpp"

#include "program/cli/values.hpp"

namespace viewgain::app {

void ScaleOptions::set(IntegrationConfig& config) const {
  if (coarsest == 0 && !fine.empty()) refuse("--fine goes with --coarsest");
  if (finest > coarsest) refuse("--finest is at most --coarsest");
  config.coarsest = static_cast<int>(coarsest);
  config.finest = static_cast<int>(finest);
  for (const std::string& box : fine) config.fine.push_back(parse_box("--fine", box));
}

Json ScaleOptions::settings() const {
  Json json = Json::object();
  if (coarsest > 0) json.update(Json{{"coarsest", coarsest}, {"fine", fine}, {"finest", finest}});
  return json;
}

void add_scale_options(App& app, ScaleOptions& options) {
  app.add_option(
         "--coarsest", options.coarsest,
         "up to 2^this voxels an edge are known as one cell where a pixel is as large, 0 to "
         "3; a nearer look makes them finer")
      ->capture_default_str()
      ->check(counted(0, 3));
  app.add_option("--fine", options.fine,
                 "x0,y0,z0,x1,y1,z1 [m]: known by single voxels all the same; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--finest", options.finest,
                 "outside of --fine cells are no smaller than 2^this voxels an edge, 0 to 3")
      ->capture_default_str()
      ->check(counted(0, 3));
}

}  // namespace viewgain::app
