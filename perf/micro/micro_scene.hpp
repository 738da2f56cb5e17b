// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "support/camel_scene.hpp"
#include "trace/view_tracer.hpp"
#include "viewgain/raycast/voxel_scene.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::bench {

/// The data of the microbenchmarks: camel-128 and some views of it. Made by the first call of get()
/// and kept. Single-threaded.
class MicroScene {
 public:
  [[nodiscard]] static const MicroScene& get();

  /// The traced tiles of a view that hit something, with the primitives in which their rays end.
  struct View {
    detail::PoseFrame frame;
    std::vector<detail::RayTile> tiles;
    std::vector<std::size_t> numbers;                ///< number of tile i in the table
    std::vector<std::vector<std::uint32_t>> leaves;  ///< of tile i
  };

  /// A tracer of the same views, by the given method.
  [[nodiscard]] detail::ViewTracer make_tracer(ExecConfig::Tracer way) const;

  Sensor sensor;
  std::vector<test::CamelView> frames;  ///< three are in the map, the fourth is new
  BeliefGrid grid;
  std::shared_ptr<const VoxelScene> scene;
  detail::ViewTracer tracer;
  std::vector<View> views;

 private:
  MicroScene();
};

/// The instruction sets that have kernels and that VIEWGAIN_ISA allows, best first.
[[nodiscard]] std::vector<Isa> micro_isas();

}  // namespace viewgain::bench
