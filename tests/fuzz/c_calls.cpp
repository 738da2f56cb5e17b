// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "fuzz/call_bytes.hpp"
#include "readers/readers.hpp"
#include "viewgain/viewgain.h"

namespace viewgain::test {
namespace {

constexpr std::size_t kMostVoxels = std::size_t{1} << 16U, kMostCalls = 60;

class Calls : CallBytes {
 public:
  using CallBytes::CallBytes;

  std::size_t run() {
    const std::string_view own = swap({});
    for (const unsigned one_of_each : {0U, 1U, 2U, 3U, 4U}) call(one_of_each);
    require(evaluators_[0] != nullptr && feasibilities_[0] != nullptr, vg_last_error());
    swap(own);
    for (std::size_t i = 0; i < kMostCalls && !empty(); ++i) call(byte());
    return succeeded();
  }

 private:
  std::vector<std::uint8_t> labels(std::int32_t x, std::int32_t y, std::int32_t z) {
    std::vector<std::uint8_t> all(static_cast<std::size_t>(x * y * z) + 1);
    const unsigned kind = byte() | 1U;
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = static_cast<std::uint8_t>(i * kind / 7 % 3);
    all[byte() % all.size()] = static_cast<std::uint8_t>(byte() % 4);
    return all;
  }
  vg_grid_info info(unsigned grid) {
    auto info = made(vg_grid_info_init);
    if (!expect(vg_grid_get_info(grids_[grid], &info))) info.dims[0] = 0;
    return info;
  }
  static std::size_t voxels(const vg_grid_info& info) {
    return std::size_t(info.dims[0]) * std::size_t(info.dims[1]) * std::size_t(info.dims[2]);
  }

  void call(unsigned which) {
    const unsigned a = byte(), b = byte(), c = byte();  // of which objects
    switch (which % 20) {
      case 0:
        return make_grid(a);
      case 1: {
        auto config = made(vg_integrator_config_init);
        config.num_threads = 1, config.support_plane = usually(kNan);
        config.carve = below(3), config.occupancy = below(3), config.coarsest = below(5);
        expect(vg_integrator_create(&sensor(), &config, integrators_.fresh(a)));
        return;
      }
      case 2: {
        auto config = made(vg_scene_config_init);
        const std::array numbers{number(), number(), -0.3,     number(), 0.3,
                                 number(), 0.2,      number(), 0.1};
        const std::array<std::uint32_t, 3> triangle{0, 1, byte() % 4U};
        config.num_threads = 1, config.support_plane = usually(kNan),
        config.hazard_rate = usually(kNan);
        config.boxes = numbers.data(), config.box_count = byte() % 2;
        config.vertices = numbers.data(), config.vertex_count = 3;
        config.triangles = triangle.data(), config.triangle_count = byte() % 2;
        expect(vg_scene_build(grids_[a], &config, scenes_.fresh(b)));
        return;
      }
      case 3: {
        auto config = made(vg_evaluator_config_init);
        const vg_weight_region region{{-0.1, number(), -1}, {0.1, number(), 1}, usually(2)};
        config.num_threads = 1, config.gain = below(4), config.criterion = below(4),
        config.tracer = below(4);
        config.pixel_stride = 1 + below(3), config.posterior_entropy = below(2);
        config.prior_sigma = usually(kNan), config.min_range = usually(kNan),
        config.max_range = usually(kNan);
        config.weights = &region, config.weight_count = byte() % 4 == 1 ? 1 : 0;
        expect(vg_evaluator_create(scenes_[a], &sensor(), &config, evaluators_.fresh(b)));
        return;
      }
      case 4: {
        auto config = made(vg_feasibility_config_init);
        config.num_threads = 1, config.clearance = usually(0),
        config.body_size[byte() % 3] = usually(0.06);
        config.sensor = byte() % 2 == 0 ? &sensor() : nullptr;
        expect(vg_feasibility_create(scenes_[a], &config, feasibilities_.fresh(b)));
        return;
      }
      case 5:
        expect(vg_scene_update(scenes_[a], grids_[b], 1, scenes_.fresh(a + 1)));
        return;
      case 6:
        expect(vg_evaluator_with_scene(evaluators_[a], scenes_[b], evaluators_.fresh(a + 1)));
        return;
      case 7:
        expect(
            vg_feasibility_with_scene(feasibilities_[a], scenes_[b], feasibilities_.fresh(a + 1)));
        return;
      case 8:
        expect(vg_grid_clone(grids_[a], grids_.fresh(a + 1)));
        return;
      case 9:
        (void)grids_.fresh(a), (void)scenes_.fresh(b), (void)evaluators_.fresh(c);
        return;
      case 10:
      case 11: {
        const std::array low{number(), number(), number()}, high{number(), number(), number()};
        std::uint64_t changed = 0;
        expect(which % 2 == 0
                   ? vg_grid_forget(grids_[a], low.data(), high.data(), &changed)
                   : vg_grid_resample(grids_[a], low.data(), high.data(), below(5), &changed));
        return;
      }
      case 12: {
        const std::array first{info(a).min_index[0] + below(8), info(a).min_index[1],
                               info(a).min_index[2] + below(8)};
        const std::array dims{below(9), 3, 4};
        const auto all = labels(dims[0], dims[1], dims[2]);
        std::uint64_t changed = 0;
        expect(vg_grid_update_box(grids_[a], first.data(), dims.data(), all.data(), &changed));
        require(changed <= all.size(), "more voxels changed than there are");
        const auto log_odds = static_cast<float>(number());
        expect(vg_grid_set(grids_[a], first.data(), &log_odds, 1));
        return;
      }
      case 13: {
        auto report = made(vg_integration_report_init);
        const auto seen = depth();
        if (!expect(vg_integrate(integrators_[a], grids_[b], seen.data(), nullptr, pose().data(),
                                 nullptr, &report))) {
          return;
        }
        require(report.readings + report.plane_readings + report.out_of_range + report.invalid ==
                    seen.size(),
                "pixels are lost");
        return;
      }
      case 14:
        expect(vg_calibrate_hazard(integrators_[a], grids_[b], scenes_[c], depth().data(),
                                   pose().data()));
        return;
      case 15: {
        std::vector<std::uint8_t> states(voxels(info(a)));
        if (!expect(vg_grid_states(grids_[a], states.data(), states.size()))) return;
        std::uint64_t occupied = 0;
        for (const std::uint8_t state : states) occupied += state == 2 ? 1 : 0;
        require(occupied == info(a).occupied, "occupied voxels are lost");
        return;
      }
      default:
        return ask(which % 20, evaluators_[a], feasibilities_[b]);
    }
  }

  void make_grid(unsigned place) {
    const double voxel = usually(0.04), sigma = usually(0.05);
    const std::array origin{usually(-0.3), -0.2, -0.2}, end{usually(0.3), 0.2, 0.2};
    if (byte() % 4 != 1) {
      const std::array dims{below(20), 9, 16};
      expect(vg_grid_from_labels(labels(dims[0], dims[1], dims[2]).data(), dims.data(),
                                 origin.data(), voxel, sigma, grids_.fresh(place)));
    } else {
      auto config = made(vg_grid_config_init);
      config.voxel_size = voxel, config.prior_sigma = sigma;
      for (std::size_t k = 0; k < 3; ++k) config.box_min[k] = origin[k], config.box_max[k] = end[k];
      config.T_world_grid[3] = number();
      expect(vg_grid_create(&config, grids_.fresh(place)));
    }
    // Large ones are for other tests.
    if (grids_[place] != nullptr && voxels(info(place)) > kMostVoxels) (void)grids_.fresh(place);
  }

  void ask(unsigned which, const vg_evaluator* evaluator, const vg_feasibility* feasibility) {
    const std::size_t count = byte() % 6, k = byte() % 5;
    const auto at = pose();
    std::vector<double> poses(at.begin(), at.end()), gains(8);
    poses.resize(16 * (count + 1));
    if (count > 0) expect(vg_sphere_poses(count, usually(0.6), origin_.data(), &poses[16]));
    std::vector<std::size_t> indices(8);
    std::size_t found = 0;
    Watch until(byte());
    if (which == 16) {
      std::vector<vg_view_gain> views(count + 1);
      if (!expect(vg_evaluate_views(evaluator, poses.data(), views.size(), views.data(),
                                    sizeof views[0], &until.watch)))
        return;
      for (const vg_view_gain& view : views) {
        require((view.status == VG_VIEW_BAD_POSE) == std::isnan(view.gain) && !(view.gain < 0),
                "a gain that is none");
      }
    } else if (which == 17) {
      const auto best = byte() % 2 == 0 ? vg_best : vg_best_set;
      expect(best(evaluator, poses.data(), count + 1, k, indices.data(), gains.data(), &found,
                  &until.watch));
    } else if (which == 18) {
      expect(vg_race(evaluator, poses.data(), count + 1, k, HUGE_VAL, byte(), indices.data(),
                     gains.data(), &found, nullptr));
      std::vector<std::int32_t> reasons(count + 1);
      expect(
          vg_feasibility_check(feasibility, poses.data(), count + 1, at.data(), 1, reasons.data()));
    } else {
      std::vector<float> image(pixels());
      expect(vg_depth_image(evaluator, at.data(), image.data(), nullptr, image.size()));
      std::vector<vg_contribution> parts(16);
      std::size_t all = 0;
      expect(vg_contributions(evaluator, at.data(), parts.data(), sizeof parts[0], parts.size(),
                              &all));
      auto rays = made(vg_ray_outcomes_init);
      if (!expect(vg_outcomes(evaluator, at.data(), &rays))) return;
      require(rays.too_near + rays.unknown + rays.known_surface + rays.obstacle +
                      rays.out_of_range + rays.out_of_map ==
                  rays.rays,
              "rays are lost");
    }
    require(found <= k && found <= count + 1, "more poses are best than there are");
    for (std::size_t i = 0; i < found; ++i) require(indices[i] <= count, "a pose that is none");
  }

  const std::array<double, 3> origin_{};
  Slots<vg_grid, vg_grid_release> grids_;
  Slots<vg_integrator, vg_integrator_release> integrators_;
  Slots<vg_scene, vg_scene_release> scenes_;
  Slots<vg_evaluator, vg_evaluator_release> evaluators_;
  Slots<vg_feasibility, vg_feasibility_release> feasibilities_;
};

}  // namespace

std::size_t c_calls(std::string_view bytes) { return Calls(bytes).run(); }

}  // namespace viewgain::test
