// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "core/temporary_folder.hpp"
#include "fuzz/call_bytes.hpp"
#include "readers/readers.hpp"

namespace viewgain::test {
namespace {

constexpr std::size_t kMostVoxels = std::size_t{1} << 14U, kMostCalls = 24;
constexpr int kMostFiles = 3;  // which take most of the time

// A scorer and what it was told: what it answers must agree with that.
class ScorerCalls : CallBytes {
 public:
  using CallBytes::CallBytes;

  std::size_t run() {
    make();
    for (std::size_t i = 0; i < kMostCalls && !empty(); ++i) call(byte());
    return succeeded();
  }

 private:
  void call(unsigned which) {
    switch (which % 12) {
      case 0:
        return make();
      case 1:
      case 2:
      case 3:
      case 4:
        return add();
      case 5:
        return set();
      case 6:
        return forget();
      case 7:
      case 8:
        return evaluate();
      case 9:
        return choose();
      case 10:
        return save_and_load();
      default:
        return look();
    }
  }

  [[nodiscard]] vg_scorer* scorer() const { return slots_[current_]; }

  void make() {
    frames_ = 0;
    config_ = made(vg_scorer_config_init);
    config_.num_threads = 1, config_.gain = below(3), config_.tracer = below(4);
    config_.pixel_stride = below(8) == 1 ? below(4) : 1;
    config_.voxel_size = usually(0.05), config_.prior_sigma = usually(kNan);
    for (std::size_t k = 0; k < 3; ++k) {
      config_.box_min[k] = usually(-0.3), config_.box_max[k] = usually(0.3);
    }
    config_.support_plane = usually(kNan), config_.object_size = usually(kNan);
    box_ = {number(), -0.1, -0.1, number(), 0.1, 0.1};
    fine_ = {-0.1, number(), -0.1, 0.1, number(), 0.1};
    config_.boxes = box_.data(), config_.box_count = byte() % 4 == 1 ? 1 : 0;
    config_.fine = fine_.data(), config_.fine_count = byte() % 4 == 1 ? 1 : 0;
    config_.coarsest = byte() % 4 == 1 ? below(5) : 0, config_.finest = below(5) == 1 ? 1 : 0;
    if (byte() % 4 == 1) config_.body_size[0] = config_.body_size[1] = config_.body_size[2] = 0.06;
    config_.clearance = usually(0), config_.jump_edge_angle = usually(0);
    expect(vg_scorer_create(&sensor(), &config_, slots_.fresh(current_)));
    // Large ones are for other tests.
    if (scorer() != nullptr && info().voxels > kMostVoxels) (void)slots_.fresh(current_);
  }

  struct Info {
    std::size_t voxels = 0;
    vg_grid_info grid{};
  };
  Info info() {
    Info all{0, made(vg_grid_info_init)};
    if (!expect(vg_scorer_grid(scorer(), grids_.fresh(0)))) return all;
    expect(vg_grid_get_info(grids_[0], &all.grid));
    all.voxels = std::accumulate(std::begin(all.grid.dims), std::end(all.grid.dims), std::size_t{1},
                                 [](std::size_t product, std::int32_t dim) {
                                   return product * static_cast<std::size_t>(dim);
                                 });
    return all;
  }

  void add() {
    const auto at = pose();
    const auto seen = depth();
    const std::array<double, 2> sigma{usually(0.001), usually(0.001)};
    auto added = made(vg_map_update_init);
    if (!expect(vg_scorer_add(scorer(), seen.data(), nullptr, at.data(),
                              byte() % 2 == 0 ? sigma.data() : nullptr, &added))) {
      return;
    }
    require(added.readings_inside <= added.readings && added.readings <= seen.size(),
            "readings that are none");
    require(added.verdict != VG_FRAME_USED || added.readings_inside > 0, "used without a reading");
    frames_ += added.verdict <= VG_FRAME_CARVED ? 1 : 0;
    require(info().grid.views >= frames_, "a view is lost");
  }

  void set() {
    std::array<std::int32_t, 3> first{}, dims{};
    for (std::size_t k = 0; k < 3; ++k) first[k] = below(16) - 8, dims[k] = below(4);
    std::vector<std::uint8_t> labels(1 + 64);
    for (std::uint8_t& label : labels) label = static_cast<std::uint8_t>(byte() % 16 == 1 ? 3 : 1);
    std::uint64_t changed = 0;
    if (!expect(vg_scorer_set(scorer(), first.data(), dims.data(), labels.data(), &changed)))
      return;
    require(changed <= static_cast<std::uint64_t>(dims[0] * dims[1] * dims[2]), "too many changes");
    require(!expect(vg_scorer_set(scorer(), first.data(), dims.data(), labels.data(), &changed)) ||
                changed == 0,
            "a second time changes something");
  }

  void forget() {
    const std::array low{number(), -1.0, -1.0}, high{number(), 1.0, 1.0};
    std::uint64_t forgotten = 0;
    const Info before = scorer() == nullptr ? Info{} : info();
    if (!expect(vg_scorer_forget(scorer(), low.data(), high.data(), &forgotten))) return;
    require(info().grid.unknown == before.grid.unknown + forgotten, "voxels are lost");
  }

  std::vector<double> poses() {
    const auto at = pose();
    std::vector<double> all(at.begin(), at.end());
    all.resize(16 * (2 + byte() % 6U));
    const std::array<double, 3> center{};
    expect(vg_sphere_poses(all.size() / 16 - 1, 0.6, center.data(), all.data() + 16));
    return all;
  }

  std::vector<double> gains(const vg_scorer* of, const std::vector<double>& at) {
    std::vector<double> values(at.size() / 16, -1);
    if (!expect(vg_scorer_evaluate(of, at.data(), values.size(), values.data(), nullptr)))
      return {};
    for (const double gain : values) require(!(gain < 0), "a gain that is none");
    return values;
  }
  void evaluate() { (void)gains(scorer(), poses()); }

  void choose() {
    const std::vector<double> at = poses();
    const std::size_t count = at.size() / 16, k = byte() % 4;
    const std::vector<double> costs(count, std::fabs(usually(1)));
    std::vector<std::size_t> indices(k);
    std::vector<double> values(k);
    std::size_t found = 0;
    Watch until(byte());
    const double seconds = byte() % 8 == 1 ? number() : kInfinity;
    expect(vg_scorer_best(scorer(), at.data(), count, k, byte() % 4 == 1 ? costs.data() : nullptr,
                          seconds, indices.data(), values.data(), &found,
                          byte() % 4 == 1 ? &until.watch : nullptr));
    require(found <= k, "more views than were asked for");
    for (std::size_t i = 0; i < found; ++i) {
      require(indices[i] < count, "a view that is none");
      require(values[i] >= 0 && std::isfinite(values[i]), "a gain that is none");
    }
  }

  // The scorer that was loaded answers as the one that was saved.
  void save_and_load() {
    if (++files_ > kMostFiles) return;
    const std::string path = (folder_.path() / "map.vdb").string();
    if (!expect(vg_scorer_save(scorer(), path.c_str()))) return;
    vg_scorer** other = slots_.fresh(1 - current_);
    require(expect(vg_scorer_load(path.c_str(), &sensor(), &config_, other)), vg_last_error());
    const std::vector<double> at = poses(), mine = gains(scorer(), at), others = gains(*other, at);
    require(std::equal(mine.begin(), mine.end(), others.begin(), others.end(),
                       [](double a, double b) { return bits(a) == bits(b); }),
            "other gains after a file");
    if (byte() % 2 == 0) current_ = 1 - current_;  // goes on with the other one
  }
  static std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

  void look() {
    auto agreed = made(vg_consistency_init);
    if (expect(vg_scorer_consistency(scorer(), &agreed, nullptr, 0))) {
      require(agreed.share_in_free >= 0 && agreed.share_in_free <= 1 &&
                  agreed.share_seen_past >= 0 && agreed.share_seen_past <= 1,
              "shares of contradictions that are none");
      require(agreed.contradicting <= agreed.frames, "more frames contradict than there are");
    }
    vg_scene* scene = nullptr;
    if (!expect(vg_scorer_scene(scorer(), &scene))) return;
    vg_scene_release(scene);
    vg_evaluator* evaluator = nullptr;
    if (!expect(vg_scorer_evaluator(scorer(), &evaluator))) return;
    auto rays = made(vg_ray_outcomes_init);
    if (expect(vg_outcomes(evaluator, pose().data(), &rays))) {
      require(rays.too_near + rays.unknown + rays.known_surface + rays.obstacle +
                      rays.out_of_range + rays.out_of_map ==
                  rays.rays,
              "rays are lost");
    }
    vg_evaluator_release(evaluator);
    if (scorer() != nullptr && info().voxels > 0) of_the_map(grids_[0]);
  }

  void of_the_map(const vg_grid* grid) {
    std::array<std::int32_t, 6> voxels{};
    const std::array points{number(), number(), number(), 0.01, -0.01, 0.2};
    expect(vg_grid_index_of(grid, points.data(), 2, voxels.data()));
    std::array<double, 6> centers{};
    expect(vg_grid_center(grid, voxels.data(), 2, centers.data()));
    std::array<std::uint8_t, 2> scales{};
    expect(vg_grid_scale(grid, voxels.data(), 2, scales.data()));
    require(scales[0] <= 3 && scales[1] <= 3, "a scale that is none");
    check_file(grid);
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
  Slots<vg_scorer, vg_scorer_release> slots_;
  unsigned current_ = 0;
  vg_scorer_config config_{};
  std::array<double, 6> box_{}, fine_{};
  std::size_t frames_ = 0;
  Slots<vg_grid, vg_grid_release> grids_;
};

}  // namespace

std::size_t scorer_calls(std::string_view bytes) { return ScorerCalls(bytes).run(); }

}  // namespace viewgain::test
