// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "map_update.hpp"

#include "apply.hpp"
#include "cone_evidence.hpp"
#include "frame_hits.hpp"
#include "line_evidence.hpp"
#include "scale_plan.hpp"

namespace viewgain::detail {

struct MapUpdate::Impl {
  Impl(const IntegrationConfig& config, const ExecConfig& exec, Isa isa)
      : literal(config.occupancy == IntegrationConfig::Occupancy::literal),
        plan(config),
        pool(exec.num_threads),
        cones(block_kernels(isa)),
        hits(surface_kernels(isa)),
        apply(block_kernels(isa), literal) {}

  bool literal;
  ScalePlan plan;
  ThreadPool pool;
  ConeEvidence cones;
  LineEvidence lines;
  FrameHits hits;
  FrameApply apply;
};

MapUpdate::MapUpdate(const IntegrationConfig& config, const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(config, exec, select_isa())) {}
MapUpdate::~MapUpdate() = default;
MapUpdate::MapUpdate(MapUpdate&&) noexcept = default;
MapUpdate& MapUpdate::operator=(MapUpdate&&) noexcept = default;

ThreadPool& MapUpdate::pool() { return impl_->pool; }

IntegrationReport MapUpdate::run(BeliefGrid& grid, const PlacedFrame& frame,
                                 const ConeCamera* camera) {
  Impl& m = *impl_;
  const BlockLattice lattice(grid.min_index(), grid.dims());
  const double voxel_size = grid.voxel_size();
  m.hits.find(frame, lattice, voxel_size, !m.literal, m.pool);
  m.plan.look(frame, grid);
  m.hits.use_cells(m.plan, grid);
  if (!m.literal) {
    m.hits.associate(frame, lattice, voxel_size, grid, m.pool);
    m.hits.use_cells(m.plan, grid);
  }
  ApplyCounts counts;
  if (camera != nullptr) {
    m.cones.gather(frame.readings, *camera, voxel_size, m.pool);
    counts = m.apply.run(grid, frame, m.cones, m.hits, m.plan, m.pool);
  } else {
    m.lines.gather(frame, lattice, voxel_size, m.pool);
    counts = m.apply.run(grid, frame, m.lines, m.hits, m.plan, m.pool);
  }

  IntegrationReport report;
  for (const PixelKind kind : frame.readings.kinds()) {
    ++(kind == PixelKind::reading        ? report.readings
       : kind == PixelKind::on_known     ? report.plane_readings
       : kind == PixelKind::out_of_range ? report.out_of_range
                                         : report.invalid);
  }
  report.readings_inside = m.hits.size();
  report.voxels_hit = counts.hit;
  report.voxels_crossed = counts.crossed;
  return report;
}

}  // namespace viewgain::detail
