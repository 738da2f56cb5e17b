// Algorithm 1 with two custom parts: candidates on a ring that comes nearer, and a choice by the
// largest gain per metre of path.
#include <cstdio>
#include <exception>
#include <memory>
#include <viewgain/planner/simulated_acquisition.hpp>
#include <viewgain/viewgain.hpp>

using namespace viewgain;

// Proposes a ring of views around the origin, 2 cm nearer each time.
class NearingRing : public ViewpointGeneration {
 public:
  Proposal generate(const Pose&) override {
    Proposal proposal;
    for (const Pose& pose : orbit_poses(24, radius_, 0.4)) {
      proposal.candidates.push_back({pose, "ring"});
    }
    radius_ -= 0.02;
    return proposal;
  }

 private:
  double radius_ = 0.55;  // [m]
};

// The representation is viewgain's; the loop asks for its progress.
class Map : public RepresentationUpdate {
 public:
  Map(const Sensor& sensor, const ScorerConfig& config) : scorer(sensor, config) {}
  ModelProgress update(const Measurements& measurements) override {
    scorer.add(measurements);
    return scorer.progress();
  }
  ViewScorer scorer;
};

// Takes the candidate with the most nats per metre of path.
class GainPerMetre : public DecisionMaking {
 public:
  explicit GainPerMetre(const Map& map) : map_(map) {}
  std::optional<Decision> decide(const Pose& from, std::span<const Candidate> candidates) override {
    std::vector<Pose> poses;
    for (const Candidate& candidate : candidates) poses.push_back(candidate.T_world_camera);
    const std::vector<ViewGain> gains = map_.scorer.evaluate(poses);
    Decision best;
    double best_rate = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double way = (poses[i].translation() - from.translation()).norm() + 0.05;  // [m]
      const double gain = gains[i].gain;
      if (gain / way <= best_rate) continue;
      best_rate = gain / way;
      best.candidate = i;
      best.gain = gain;
    }
    if (best_rate == 0) return {};
    return best;
  }

 private:
  const Map& map_;
};

int main() try {
  // The object is a box of 16 cm, seen by a simulated SR4000.
  const Obstacles box{{{{-0.08, -0.08, -0.08}, {0.08, 0.08, 0.08}}}, {}};
  const Sensor sensor = sensor_preset("sr4000");
  SimulatedAcquisition camera(
      SimulatedSensor(std::make_shared<const SurfaceScene>(mesh_of(box)), sensor), 1, {});

  ScorerConfig config;
  config.voxel_size = 0.01;
  config.workspace = {{-0.15, -0.15, -0.15}, {0.15, 0.15, 0.15}};
  Map map(sensor, config);
  NearingRing ring;
  GainPerMetre choice(map);
  PlanningConfig rules;
  rules.max_views = 5;
  const PlanningResult result =
      active_view_planning(look_at({0.5, 0.1, 0.2}, {0, 0, 0}), camera, map, ring, choice, rules);
  for (const ViewRecord& view : result.views) {
    std::printf("view %zu: %llu voxels unknown, %.2f m on the way\n", view.index,
                static_cast<unsigned long long>(view.progress.unknown_voxels), view.travelled);
  }
  std::printf("ended by %s\n", std::string(stop_reason_name(result.reason)).c_str());
} catch (const std::exception& error) {
  std::fprintf(stderr, "own_loop: %s\n", error.what());
  return 2;
}
