// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <utility>

#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/raycast/gain_family.hpp"

namespace viewgain {
namespace {

// Its evaluators share the map and are made when their stride is first needed.
class LiteratureEvaluator : public FamilyEvaluator {
 public:
  LiteratureEvaluator(std::shared_ptr<const ClassicMap> map, const Sensor& sensor,
                      std::vector<ClassicGain> gains, const ExecConfig& exec)
      : map_(std::move(map)), sensor_(sensor), gains_(std::move(gains)), exec_(exec) {
    (void)of_stride(1);  // throws if a gain is not available
  }

  void evaluate(std::span<const Pose> T_world_camera, int pixel_stride, std::span<double> results,
                std::span<ViewGain::Status> statuses, const BatchControl& control) override {
    of_stride(pixel_stride).evaluate(T_world_camera, results, statuses, control);
  }
  [[nodiscard]] std::size_t rays_per_pose() const override {
    return static_cast<std::size_t>(sensor_.camera.width) *
           static_cast<std::size_t>(sensor_.camera.height);
  }

 private:
  const ClassicGainEvaluator& of_stride(int stride) {
    const auto found = by_stride_.find(stride);
    if (found != by_stride_.end()) return found->second;
    ClassicConfig config;
    config.gains = gains_;
    config.pixel_stride = stride;
    return by_stride_.try_emplace(stride, map_, sensor_, config, exec_).first->second;
  }

  std::shared_ptr<const ClassicMap> map_;
  Sensor sensor_;
  std::vector<ClassicGain> gains_;
  ExecConfig exec_;
  std::map<int, ClassicGainEvaluator> by_stride_;
};

class LiteratureGains : public GainFamily {
 public:
  [[nodiscard]] const std::vector<std::string>& names() const override {
    return classic_gain_names();
  }
  [[nodiscard]] std::string_view unit(std::string_view name) const override {
    return classic_gain_unit(parse_classic_gain(name));
  }
  [[nodiscard]] std::unique_ptr<FamilyEvaluator> evaluator(std::shared_ptr<const VoxelScene> scene,
                                                           const BeliefGrid& grid,
                                                           const Sensor& sensor,
                                                           std::span<const std::string> names,
                                                           const ExecConfig& exec) const override {
    std::vector<ClassicGain> gains;
    for (const std::string& name : names) gains.push_back(parse_classic_gain(name));
    std::optional<Acquisition> acquisition;
    if (std::any_of(gains.begin(), gains.end(), needs_occlusion)) acquisition = {sensor};
    auto map = ClassicMap::build(std::move(scene), grid, acquisition, exec);
    return std::make_unique<LiteratureEvaluator>(std::move(map), sensor, std::move(gains), exec);
  }
};

}  // namespace

std::shared_ptr<const GainFamily> literature_gains() {
  return std::make_shared<const LiteratureGains>();
}

}  // namespace viewgain
