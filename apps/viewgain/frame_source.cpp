// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "formats/frames_dir.hpp"
#include "planner/sensing.hpp"
#include "reading_source.hpp"
#include "viewgain/core/jump_edge_filter.hpp"

namespace viewgain::app {
namespace {

IntegrationConfig config_of(const IntegrateOptions& options) {
  IntegrationConfig config;
  config.carve = options.carve == "cones" ? Carve::cones : Carve::lines;
  config.occupancy = options.occupancy_rule();
  config.support_plane = options.support_plane;
  return config;
}

class FrameSource : public ReadingSource {
 public:
  explicit FrameSource(const IntegrateOptions& options)
      : frames_(open_frames(options.frames, options.sensor, options.depth_scale)),
        meaning_(options.out_of_range == "carve" ? OutOfRangeMeaning::carve
                                                 : OutOfRangeMeaning::invalid),
        support_plane_(options.support_plane),
        integrator_(frames_.sensor, config_of(options), {options.common.threads}) {
    const auto config =
        parse_jump_edge_filter(options.jump_edge_filter, options.jump_edge_two_sided);
    if (config) filter_.emplace(frames_.sensor.camera, *config);
  }

  [[nodiscard]] const Sensor& sensor() const override { return frames_.sensor; }
  [[nodiscard]] std::size_t size() const override { return frames_.images.size(); }
  [[nodiscard]] std::size_t orthonormalized() const override { return frames_.orthonormalized; }

  void load(std::size_t index) override {
    index_ = index;
    frame_ = load_frame(frames_, index, meaning_);
    removed_ = filter_ ? filter_->apply(frame_) : 0;
  }
  [[nodiscard]] std::optional<Box> bounds() const override {
    return reading_bounds(frames_.sensor, frame_, frames_.poses[index_], {}, support_plane_);
  }
  IntegrationReport integrate(BeliefGrid& grid) override {
    return integrator_.integrate(grid, frame_, frames_.poses[index_]);
  }
  [[nodiscard]] std::uint64_t jump_edge_removed() const override { return removed_; }
  [[nodiscard]] std::optional<double> depth_scale() const override { return frames_.depth_scale; }

 private:
  FrameSequence frames_;
  OutOfRangeMeaning meaning_;
  std::optional<double> support_plane_;
  std::optional<JumpEdgeFilter> filter_;
  FrameIntegrator integrator_;
  std::size_t index_ = 0;
  DepthFrame frame_;
  std::uint64_t removed_ = 0;
};

}  // namespace

std::unique_ptr<ReadingSource> open_frame_source(const IntegrateOptions& options) {
  return std::make_unique<FrameSource>(options);
}

}  // namespace viewgain::app
