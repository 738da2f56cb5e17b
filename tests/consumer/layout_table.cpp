// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Sizes and alignments of the public types, compiled once with the library's flags and once for
// AVX-512, where Eigen aligns to 64 bytes; constants only, so that the second is never run.
#include "layout_table.hpp"

#include "viewgain/viewgain.hpp"
#ifdef VIEWGAIN_WITH_FORMATS
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/ply.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/run_folder.hpp"
#endif
#ifdef VIEWGAIN_WITH_PLANNER
#include "viewgain/planner/feasible_poses.hpp"
#include "viewgain/planner/map_model.hpp"
#include "viewgain/planner/point_arrays.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner/proximity_measure.hpp"
#include "viewgain/planner/realised_area.hpp"
#include "viewgain/planner/simulated_acquisition.hpp"
#include "viewgain/planner/view_planner.hpp"
#include "viewgain/planner/view_sight.hpp"
#endif
#ifdef VIEWGAIN_WITH_PLANNER_MESH
#include "viewgain/planner_mesh/boundary_generation.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/planner_mesh/stage.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#endif
#ifdef VIEWGAIN_WITH_MESH
#include "viewgain/mesh/boundary.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/mesh/patch.hpp"
#include "viewgain/mesh/quality.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#endif

namespace viewgain::layout_test {

static_assert(alignof(Eigen::Isometry3d) == VIEWGAIN_EXPECTED_EIGEN_ALIGNMENT,
              "the flags do what this test is about");

template <typename Type>
consteval Layout layout_of(const char* name) {
  static_assert(alignof(Type) <= 8, "holds an Eigen type whose alignment follows -march");
  return {name, sizeof(Type), alignof(Type)};
}

#define VIEWGAIN_LAYOUT(type) layout_of<type>(#type)
extern constinit const Layout VIEWGAIN_LAYOUT_TABLE[] = {VIEWGAIN_LAYOUT(ApproximateConfig),
                                                         VIEWGAIN_LAYOUT(ApproximateGain),
                                                         VIEWGAIN_LAYOUT(BatchControl),
                                                         VIEWGAIN_LAYOUT(Belief),
                                                         VIEWGAIN_LAYOUT(BeliefBlock),
                                                         VIEWGAIN_LAYOUT(BeliefBlockAt),
                                                         VIEWGAIN_LAYOUT(BeliefGrid),
                                                         VIEWGAIN_LAYOUT(BestViews),
                                                         VIEWGAIN_LAYOUT(Box),
                                                         VIEWGAIN_LAYOUT(Acquisition),
                                                         VIEWGAIN_LAYOUT(Candidate),
                                                         VIEWGAIN_LAYOUT(ClassicConfig),
                                                         VIEWGAIN_LAYOUT(ClassicGainEvaluator),
                                                         VIEWGAIN_LAYOUT(Decision),
                                                         VIEWGAIN_LAYOUT(DepthFrame),
                                                         VIEWGAIN_LAYOUT(DepthImage),
                                                         VIEWGAIN_LAYOUT(Error),
                                                         VIEWGAIN_LAYOUT(ExecConfig),
                                                         VIEWGAIN_LAYOUT(FeasibilityChecker),
                                                         VIEWGAIN_LAYOUT(FeasibilityConfig),
                                                         VIEWGAIN_LAYOUT(FrameIntegrator),
                                                         VIEWGAIN_LAYOUT(FusedPoint),
                                                         VIEWGAIN_LAYOUT(FusedPointsConfig),
                                                         VIEWGAIN_LAYOUT(GainConfig),
                                                         VIEWGAIN_LAYOUT(GainEvaluator),
                                                         VIEWGAIN_LAYOUT(GridConfig),
                                                         VIEWGAIN_LAYOUT(GridSnapshot),
                                                         VIEWGAIN_LAYOUT(GridStatistics),
                                                         VIEWGAIN_LAYOUT(HalfSpace),
                                                         VIEWGAIN_LAYOUT(Index3),
                                                         VIEWGAIN_LAYOUT(IntegrationConfig),
                                                         VIEWGAIN_LAYOUT(IntegrationReport),
                                                         VIEWGAIN_LAYOUT(JumpEdgeConfig),
                                                         VIEWGAIN_LAYOUT(JumpEdgeFilter),
                                                         VIEWGAIN_LAYOUT(Measurements),
                                                         VIEWGAIN_LAYOUT(ModelProgress),
                                                         VIEWGAIN_LAYOUT(NoiseModel),
                                                         VIEWGAIN_LAYOUT(Obstacles),
                                                         VIEWGAIN_LAYOUT(OccupancyCodes),
                                                         VIEWGAIN_LAYOUT(ObstacleView),
                                                         VIEWGAIN_LAYOUT(OccupiedVoxel),
                                                         VIEWGAIN_LAYOUT(PinholeCamera),
                                                         VIEWGAIN_LAYOUT(PixelTruth),
                                                         VIEWGAIN_LAYOUT(PlanningConfig),
                                                         VIEWGAIN_LAYOUT(PlanningResult),
                                                         VIEWGAIN_LAYOUT(Pose),
                                                         VIEWGAIN_LAYOUT(PoseList),
                                                         VIEWGAIN_LAYOUT(PoseSigma),
                                                         VIEWGAIN_LAYOUT(PoseTolerance),
                                                         VIEWGAIN_LAYOUT(Proposal),
                                                         VIEWGAIN_LAYOUT(RaceConfig),
                                                         VIEWGAIN_LAYOUT(RangeCalibration),
                                                         VIEWGAIN_LAYOUT(RangeCorrector),
                                                         VIEWGAIN_LAYOUT(RayHit),
                                                         VIEWGAIN_LAYOUT(ReachRegion),
                                                         VIEWGAIN_LAYOUT(RegionStatistics),
                                                         VIEWGAIN_LAYOUT(Sensor),
                                                         VIEWGAIN_LAYOUT(SensorBody),
                                                         VIEWGAIN_LAYOUT(Shell),
                                                         VIEWGAIN_LAYOUT(SimulatedSensor),
                                                         VIEWGAIN_LAYOUT(SimulationConfig),
                                                         VIEWGAIN_LAYOUT(SnapshotLeaf),
                                                         VIEWGAIN_LAYOUT(StopMemory),
                                                         VIEWGAIN_LAYOUT(StopRules),
                                                         VIEWGAIN_LAYOUT(SurfaceHit),
                                                         VIEWGAIN_LAYOUT(SurfaceScene),
                                                         VIEWGAIN_LAYOUT(SymmetricMatrix3),
                                                         VIEWGAIN_LAYOUT(ThreadPool),
                                                         VIEWGAIN_LAYOUT(TriangleMesh),
                                                         VIEWGAIN_LAYOUT(VdbMap),
                                                         VIEWGAIN_LAYOUT(VdbWriteConfig),
                                                         VIEWGAIN_LAYOUT(ViewGain),
                                                         VIEWGAIN_LAYOUT(ViewHit),
                                                         VIEWGAIN_LAYOUT(VoxelBox),
                                                         VIEWGAIN_LAYOUT(VoxelContribution),
                                                         VIEWGAIN_LAYOUT(ViewRecord),
                                                         VIEWGAIN_LAYOUT(ViewSet),
                                                         VIEWGAIN_LAYOUT(VoxelScene),
                                                         VIEWGAIN_LAYOUT(VoxelValue),
                                                         VIEWGAIN_LAYOUT(WallCalibration),
                                                         VIEWGAIN_LAYOUT(WallCalibrationResult),
                                                         VIEWGAIN_LAYOUT(WallFrameFigures),
                                                         VIEWGAIN_LAYOUT(WeightRegion),
#ifdef VIEWGAIN_WITH_FORMATS
                                                         VIEWGAIN_LAYOUT(FrameSequence),
                                                         VIEWGAIN_LAYOUT(FramesWriter),
                                                         VIEWGAIN_LAYOUT(Gray8Image),
                                                         VIEWGAIN_LAYOUT(GrayImage),
                                                         VIEWGAIN_LAYOUT(LostInTree),
                                                         VIEWGAIN_LAYOUT(PlyArrays),
                                                         VIEWGAIN_LAYOUT(RgbImage),
                                                         VIEWGAIN_LAYOUT(RunFolder),
                                                         VIEWGAIN_LAYOUT(StagedFolder),
#endif
#ifdef VIEWGAIN_WITH_PLANNER
                                                         VIEWGAIN_LAYOUT(AddedView),
                                                         VIEWGAIN_LAYOUT(DroppedCandidate),
                                                         VIEWGAIN_LAYOUT(FeasiblePoses),
                                                         VIEWGAIN_LAYOUT(MapModel),
                                                         VIEWGAIN_LAYOUT(MapModelConfig),
                                                         VIEWGAIN_LAYOUT(MapUpdate),
                                                         VIEWGAIN_LAYOUT(PlannerConfig),
                                                         VIEWGAIN_LAYOUT(PointArrays),
                                                         VIEWGAIN_LAYOUT(PoseSet),
                                                         VIEWGAIN_LAYOUT(PoseSetRequest),
                                                         VIEWGAIN_LAYOUT(ProximityMeasure),
                                                         VIEWGAIN_LAYOUT(RankConfig),
                                                         VIEWGAIN_LAYOUT(RankedView),
                                                         VIEWGAIN_LAYOUT(Ranking),
                                                         VIEWGAIN_LAYOUT(RealisedArea),
                                                         VIEWGAIN_LAYOUT(SimulatedAcquisition),
                                                         VIEWGAIN_LAYOUT(ViewPlanner),
                                                         VIEWGAIN_LAYOUT(ViewSight),
#endif
#ifdef VIEWGAIN_WITH_PLANNER_MESH
                                                         VIEWGAIN_LAYOUT(BoundaryGeneration),
                                                         VIEWGAIN_LAYOUT(BoundaryOrder),
                                                         VIEWGAIN_LAYOUT(BoundaryViewsConfig),
                                                         VIEWGAIN_LAYOUT(CandidateGeneration),
                                                         VIEWGAIN_LAYOUT(GenerationConfig),
                                                         VIEWGAIN_LAYOUT(KnownObject),
                                                         VIEWGAIN_LAYOUT(OracleChoice),
                                                         VIEWGAIN_LAYOUT(ClassicChoice),
                                                         VIEWGAIN_LAYOUT(ClassicRanking),
                                                         VIEWGAIN_LAYOUT(PolicyConfig),
                                                         VIEWGAIN_LAYOUT(PolicyDecision),
                                                         VIEWGAIN_LAYOUT(QualityFigures),
                                                         VIEWGAIN_LAYOUT(Stage),
                                                         VIEWGAIN_LAYOUT(StageConfig),
                                                         VIEWGAIN_LAYOUT(SurfaceModel),
                                                         VIEWGAIN_LAYOUT(SurfaceModelConfig),
                                                         VIEWGAIN_LAYOUT(TravelCost),
                                                         VIEWGAIN_LAYOUT(Truth),
                                                         VIEWGAIN_LAYOUT(VisibilityConfig),
#endif
#ifdef VIEWGAIN_WITH_MESH
                                                         VIEWGAIN_LAYOUT(BoundaryCandidate),
                                                         VIEWGAIN_LAYOUT(BoundaryConfig),
                                                         VIEWGAIN_LAYOUT(BoundaryLoop),
                                                         VIEWGAIN_LAYOUT(BoundaryRun),
                                                         VIEWGAIN_LAYOUT(Consistency),
                                                         VIEWGAIN_LAYOUT(ErrorStatistics),
                                                         VIEWGAIN_LAYOUT(EstimatedViews),
                                                         VIEWGAIN_LAYOUT(EstimatorConfig),
                                                         VIEWGAIN_LAYOUT(GroundTruth),
                                                         VIEWGAIN_LAYOUT(MeshPlacement),
                                                         VIEWGAIN_LAYOUT(OrientedPoint),
                                                         VIEWGAIN_LAYOUT(QuadraticPatch),
                                                         VIEWGAIN_LAYOUT(SurfaceConfig),
                                                         VIEWGAIN_LAYOUT(SurfaceMesh),
                                                         VIEWGAIN_LAYOUT(SurfaceSample),
#endif
                                                         {nullptr, 0, 0}};

}  // namespace viewgain::layout_test
