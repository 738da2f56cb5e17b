// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "core/temporary_folder.hpp"
#include "fuzz/call_bytes.hpp"
#include "readers/readers.hpp"
#include "viewgain/planner.h"

namespace viewgain::test {
namespace {

constexpr std::size_t kMostVoxels = std::size_t{1} << 14U, kMostCalls = 24, kMostPoses = 40;
constexpr int kMostFiles = 3;  // which take most of the time

// A planner, what it was made with, and what it was told: what it answers must add up with that.
struct Planned {
  Slots<vg_planner, vg_planner_release> slots;
  unsigned current = 0;
  vg_planner_config config{};
  std::array<double, 6> box{}, fine{};
  std::vector<double> poses;
  std::size_t views = 0;
  std::size_t candidates = 0;
  bool is_proposed = false;

  Planned() = default;
  Planned(const Planned&) = delete;
  Planned& operator=(const Planned&) = delete;
  [[nodiscard]] vg_planner* planner() const { return slots[current]; }
};

struct Ranked {
  vg_status status = VG_OK;
  std::vector<vg_ranked_view> views;
};

class PlannerCalls : CallBytes {
 public:
  using CallBytes::CallBytes;

  std::size_t run() {
    make();
    for (std::size_t i = 0; i < kMostCalls && !empty(); ++i) call(byte());
    return succeeded();
  }

 private:
  void call(unsigned which) {
    switch (which % 16) {
      case 0:
        return make();
      case 1:
        return add_poses();
      case 2:
      case 3:
      case 4:
        return add();
      case 5:
        return drop();
      case 6:
      case 7:
        return propose();
      case 8:
      case 9:
        return rank();
      case 10:
        return rank_poses();
      case 11: {
        const auto at = pose();
        // A pose that was proposed, or one that was not.
        const double* tried = at.data();
        if (byte() % 2 == 0 && !now_.poses.empty()) tried = &now_.poses[16 * (byte() % count())];
        expect(vg_planner_tried(now_.planner(), tried, below(2)));
        return;
      }
      case 12:
        return look();
      case 13:
        return registered();
      case 14:
        return save_and_load();
      default:
        return of_the_map();
    }
  }

  [[nodiscard]] std::size_t count() const { return now_.poses.size() / 16; }

  void make() {
    now_.poses.clear();
    now_.views = now_.candidates = 0, now_.is_proposed = false;
    vg_planner_config& config = now_.config;
    config = made(vg_planner_config_init);
    config.num_threads = 1, config.gain = below(3);
    config.voxel_size = usually(0.05), config.prior_sigma = usually(kNan);
    for (std::size_t k = 0; k < 3; ++k) {
      config.box_min[k] = usually(-0.3), config.box_max[k] = usually(0.3);
    }
    config.support_plane = usually(kNan);
    now_.box = {number(), -0.1, -0.1, number(), 0.1, 0.1};
    now_.fine = {-0.1, number(), -0.1, 0.1, number(), 0.1};
    config.boxes = now_.box.data(), config.box_count = byte() % 4 == 1 ? 1 : 0;
    config.fine = now_.fine.data(), config.fine_count = byte() % 4 == 1 ? 1 : 0;
    config.coarsest = byte() % 4 == 1 ? below(5) : 0, config.finest = below(5) == 1 ? below(3) : 0;
    config.check_feasibility = byte() % 4 == 1 ? 0 : 1;
    config.body_size[byte() % 3] = usually(0.06), config.clearance = usually(0);
    if (byte() % 8 == 1) {
      config.reachable = [](const double pose[16], void*) { return pose[3] < 0.1 ? 1 : 0; };
    }
    config.max_views = 1 + byte() % 16U, config.idle_views = byte() % 4;
    config.broken_promises = byte() % 4;
    config.plan = 1 + byte() % 5U, config.take = 1 + byte() % 3U;
    config.stop_gain = usually(kNan), config.stop_area = usually(kNan), config.tracer = below(4);
    vg_planner** planner = now_.slots.fresh(now_.current);
    expect(vg_planner_create(&sensor(), &config, planner));
    // Large ones are for other tests.
    if (now_.planner() != nullptr && voxels() > kMostVoxels) (void)now_.slots.fresh(now_.current);
    add_poses();
  }

  std::size_t voxels() {
    vg_grid** grid = grids_.fresh(0);
    if (!expect(vg_planner_grid(now_.planner(), grid))) return 0;
    auto info = made(vg_grid_info_init);
    expect(vg_grid_get_info(*grid, &info));
    return std::size_t(info.dims[0]) * std::size_t(info.dims[1]) * std::size_t(info.dims[2]);
  }

  void add_poses() {
    const std::size_t more = 1 + byte() % 12U;
    std::vector<double> poses(16 * more);
    const std::array<double, 3> center{};
    if (!expect(vg_sphere_poses(more, usually(0.6), center.data(), poses.data()))) return;
    if (byte() % 8 == 1) poses[byte() % poses.size()] = number();
    if (count() + more > kMostPoses) return;
    if (!expect(vg_planner_add_poses(now_.planner(), poses.data(), more))) return;
    now_.poses.insert(now_.poses.end(), poses.begin(), poses.end());
    now_.is_proposed = false;  // the last proposal is void
  }

  void add() {
    const auto at = pose();
    const auto seen = depth();
    const std::array<double, 2> sigma{usually(0.001), usually(0.001)};
    auto added = made(vg_planner_view_init);
    if (!expect(vg_planner_add(now_.planner(), seen.data(), nullptr, at.data(),
                               byte() % 2 == 0 ? sigma.data() : nullptr, &added))) {
      return;
    }
    require(added.view == now_.views, "a view is lost");
    require(added.readings_inside <= added.readings && added.readings <= seen.size(),
            "readings that are none");
    require(added.verdict >= VG_FRAME_USED && added.verdict < VG_FRAME_VERDICTS, "no verdict");
    require(added.verdict != VG_FRAME_USED || added.readings > 0, "used without a reading");
    ++now_.views;
    now_.is_proposed = false;
  }

  void drop() {
    const auto at = pose();
    if (!expect(vg_planner_drop(now_.planner(), below(13) - 1,
                                byte() % 2 == 0 ? at.data() : nullptr))) {
      return;
    }
    ++now_.views;
    now_.is_proposed = false;
  }

  struct Proposed {
    vg_status status = VG_OK;
    std::size_t candidates = 0;
    std::array<std::size_t, VG_PLANNER_REASONS> dropped{};
    bool operator==(const Proposed&) const = default;
  };
  Proposed proposal_of(vg_planner* planner) {
    Proposed made;
    made.status =
        vg_planner_propose(planner, &made.candidates, made.dropped.data(), made.dropped.size());
    expect(made.status);
    return made;
  }
  void propose() {
    const Proposed made = proposal_of(now_.planner());
    if (made.status != VG_OK) return;
    const std::size_t all =
        std::accumulate(made.dropped.begin(), made.dropped.end(), made.candidates);
    require(all == count() || (now_.config.plan > 1 && made.candidates <= now_.config.plan),
            "candidates are lost");
    now_.candidates = made.candidates, now_.is_proposed = true;
  }

  // Where the camera is: null, or a pose that may be none.
  struct Here {
    std::array<double, 16> pose{};
    bool is_given = false;
    [[nodiscard]] const double* get() const { return is_given ? pose.data() : nullptr; }
  };
  Here here() {
    Here made;
    made.is_given = byte() % 4 == 1;
    if (made.is_given) made.pose = pose();
    return made;
  }

  Ranked ranking_of(vg_planner* planner, std::size_t k, double per_metre, const Here& here,
                    const vg_watch* watch) {
    Ranked ranked{VG_OK, std::vector<vg_ranked_view>(k)};
    std::size_t found = 0;
    ranked.status = vg_planner_rank(planner, k, nullptr, 0, per_metre, here.get(),
                                    ranked.views.data(), sizeof(vg_ranked_view), &found, watch);
    expect(ranked.status);
    require(found <= k, "more views than were asked for");
    ranked.views.resize(found);
    return ranked;
  }
  void check(const Ranked& ranked, std::size_t of) {
    for (const vg_ranked_view& view : ranked.views) {
      require(view.index < of, "a view that is none");
      require(view.gain >= 0 && std::isfinite(view.gain) && view.worth <= view.gain,
              "a gain that is none");
    }
  }
  void rank() {
    Watch until(byte());
    const std::size_t k = byte() % 6;
    const double per_metre = usually(0);
    const Here from = here();
    const Ranked ranked =
        ranking_of(now_.planner(), k, per_metre, from, byte() % 2 == 0 ? &until.watch : nullptr);
    require(ranked.status != VG_OK || now_.is_proposed, "ranked without a proposal");
    check(ranked, now_.candidates);
  }

  void rank_poses() {
    const auto at = pose();
    std::vector<double> poses(at.begin(), at.end());
    poses.insert(poses.end(), now_.poses.begin(), now_.poses.end());
    std::vector<double> costs(poses.size() / 16, std::fabs(usually(1)));
    const std::size_t k = byte() % 4;
    Ranked ranked{VG_OK, std::vector<vg_ranked_view>(k)};
    std::size_t found = 0;
    const std::size_t cost_count = byte() % 4 == 1 ? costs.size() : 0;
    const double per_metre = usually(0);
    const Here from = here();
    expect(vg_planner_rank_poses(now_.planner(), poses.data(), poses.size() / 16, k, costs.data(),
                                 cost_count, per_metre, from.get(), ranked.views.data(),
                                 sizeof(vg_ranked_view), &found, nullptr));
    require(found <= k, "more views than were asked for");
    ranked.views.resize(found);
    check(ranked, poses.size() / 16);
  }

  void look() {
    std::array<std::size_t, VG_FRAME_VERDICTS> frames{};
    if (expect(vg_planner_frames(now_.planner(), frames.data(), frames.size()))) {
      require(std::accumulate(frames.begin(), frames.end(), std::size_t{0}) == now_.views,
              "frames are lost");
    }
    std::int32_t reason = 0;
    if (expect(vg_planner_should_stop(now_.planner(), &reason))) {
      require(reason >= VG_GO_ON && reason <= VG_STOP_MAX_VIEWS, "no reason");
      require(now_.views < now_.config.max_views || reason != VG_GO_ON, "more views than asked");
    }
    auto agreed = made(vg_consistency_init);
    if (expect(vg_planner_consistency(now_.planner(), &agreed, nullptr, 0))) {
      require(agreed.share_in_free >= 0 && agreed.share_in_free <= 1 &&
                  agreed.share_seen_past >= 0 && agreed.share_seen_past <= 1,
              "shares of contradictions that are none");
      require(agreed.contradicting <= agreed.frames, "more frames contradict than there are");
    }
    auto rays = made(vg_ray_outcomes_init);
    if (!expect(vg_planner_outcomes(now_.planner(), pose().data(), &rays))) return;
    require(rays.too_near + rays.unknown + rays.known_surface + rays.obstacle + rays.out_of_range +
                    rays.out_of_map ==
                rays.rays,
            "rays are lost");
  }

  void registered() {
    auto found = made(vg_registration_init);
    const auto at = pose();
    if (!expect(vg_planner_register(now_.planner(), depth().data(), nullptr, at.data(),
                                    usually(0.01), usually(0.01), &found))) {
      return;
    }
    for (const double value : found.T_world_camera)
      require(std::isfinite(value), "a pose that is none");
    require(found.status == VG_REGISTERED ||
                std::equal(at.begin(), at.end(), std::begin(found.T_world_camera),
                           [](double a, double b) { return std::fabs(a - b) < 1e-12; }),
            "moved, but not registered");
    require(found.overlap >= 0 && found.overlap <= 1 && found.contradiction >= 0 &&
                found.contradiction <= 1,
            "shares that are none");
  }

  // The planner that was loaded answers as the one that was saved.
  void save_and_load() {
    if (++files_ > kMostFiles) return;
    const std::string path = (folder_.path() / "state.vdb").string();
    if (!expect(vg_planner_save(now_.planner(), path.c_str()))) return;
    vg_planner** other = now_.slots.fresh(1 - now_.current);
    require(expect(vg_planner_load(path.c_str(), &sensor(), &now_.config, other)), vg_last_error());
    if (!now_.poses.empty()) {
      require(expect(vg_planner_add_poses(*other, now_.poses.data(), count())), vg_last_error());
    }
    now_.is_proposed = false;
    const Proposed mine = proposal_of(now_.planner());
    require(proposal_of(*other) == mine, "other candidates after a file");
    if (mine.status == VG_OK) {
      now_.candidates = mine.candidates, now_.is_proposed = true;
      const std::size_t k = byte() % 4;
      const double per_metre = usually(0);
      const Here from = here();
      const Ranked mine_ranked = ranking_of(now_.planner(), k, per_metre, from, nullptr);
      const Ranked others = ranking_of(*other, k, per_metre, from, nullptr);
      require(
          mine_ranked.status == others.status && mine_ranked.views.size() == others.views.size() &&
              std::equal(mine_ranked.views.begin(), mine_ranked.views.end(), others.views.begin(),
                         [](const vg_ranked_view& a, const vg_ranked_view& b) {
                           return a.index == b.index && bits(a.gain) == bits(b.gain) &&
                                  bits(a.worth) == bits(b.worth);
                         }),
          "another ranking after a file");
    }
    std::array<std::int32_t, 2> reasons{};
    expect(vg_planner_should_stop(now_.planner(), &reasons[0]));
    expect(vg_planner_should_stop(*other, &reasons[1]));
    require(reasons[0] == reasons[1], "another reason after a file");
    if (byte() % 2 == 0) now_.current = 1 - now_.current;  // goes on with the other one
  }
  static std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

  void of_the_map() {
    vg_grid** grid = grids_.fresh(0);
    if (!expect(vg_planner_grid(now_.planner(), grid))) return;
    std::array<std::int32_t, 6> voxels{};
    const std::array points{number(), number(), number(), 0.01, -0.01, 0.2};
    expect(vg_grid_index_of(*grid, points.data(), 2, voxels.data()));
    std::array<double, 6> centers{};
    expect(vg_grid_center(*grid, voxels.data(), 2, centers.data()));
    std::array<std::uint8_t, 2> scales{};
    expect(vg_grid_scale(*grid, voxels.data(), 2, scales.data()));
    require(scales[0] <= 3 && scales[1] <= 3, "a scale that is none");
    std::vector<std::int32_t> occupied(3 * 8);
    std::size_t found = 0;
    expect(vg_grid_occupied(*grid, occupied.data(), nullptr, 8, &found));
    auto info = made(vg_grid_info_init);
    expect(vg_grid_get_info(*grid, &info));
    require(found <= info.occupied, "more occupied voxels than there are");

    check_file(*grid);
    check_order();
  }

  void check_file(const vg_grid* grid) {
    if (++files_ > kMostFiles) return;
    const std::string path = (folder_.path() / "map.vdb").string();
    require(expect(vg_grid_save(grid, path.c_str())), vg_last_error());
    require(expect(vg_grid_load(path.c_str(), grids_.fresh(1))), vg_last_error());
    std::array<char, 17> hash{}, loaded{};
    expect(vg_grid_hash(grid, hash.data()));
    expect(vg_grid_hash(grids_[1], loaded.data()));
    require(hash == loaded, "another map after a file");
  }

  void check_order() {
    const std::size_t stops = byte() % 5;
    std::vector<double> costs((stops + 1) * stops);
    for (double& cost : costs) cost = std::fabs(usually(1));
    std::vector<std::size_t> order(stops, stops);
    double cost = 0;
    if (!expect(vg_order_stops(costs.data(), stops, order.data(), &cost))) return;
    require(cost >= 0, "a cost that is none");
    if (!std::isfinite(cost)) return;
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < stops; ++i) require(order[i] == i, "a stop is lost");
  }

  TemporaryFolder folder_;
  int files_ = 0;
  Planned now_;
  Slots<vg_grid, vg_grid_release> grids_;
};

}  // namespace

std::size_t planner_calls(std::string_view bytes) { return PlannerCalls(bytes).run(); }

}  // namespace viewgain::test
