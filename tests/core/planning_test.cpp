// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/planning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "expect_error.hpp"
#include "viewgain/support/stop_rules.hpp"

namespace viewgain {
namespace {
using Decision = DecisionMaking::Decision;

using test::expect_error;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Pose at(double x) { return {Eigen::Matrix3d::Identity(), {x, 0, 0}}; }

Candidate candidate(double x) { return {at(x), "script", BoundaryClass::left, 7}; }

/// The four parts, played from a script: one entry a view, the last one for all later views.
class Script : public DataAcquisition,
               public RepresentationUpdate,
               public ViewpointGeneration,
               public DecisionMaking {
 public:
  std::vector<ModelProgress> progress{{100, 1000, {}}};
  std::vector<Proposal> proposals{{{candidate(1), candidate(3)}, {}}};
  std::vector<std::optional<Decision>> decisions{Decision{1, 5, 1}};
  std::string calls;  ///< a, u, g, d in the order of the calls
  std::stop_source stop;
  std::size_t stop_after = 0;   ///< ask for the end in this call, from 1
  std::size_t throw_after = 0;  ///< throw in it
  std::vector<Pose> acquired;
  double drift = 0;  ///< how far from the asked pose measurements are taken

  Measurements acquire(const Pose& T_world_camera, std::size_t view) override {
    EXPECT_EQ(view, acquired.size());
    acquired.push_back(T_world_camera);
    called('a');
    return {at(T_world_camera.translation().x() + drift), {}};
  }
  ModelProgress update(const Measurements& measurements) override {
    EXPECT_EQ(measurements.T_world_camera, at(acquired.back().translation().x() + drift));
    called('u');
    return entry(progress);
  }
  Proposal generate(const Pose& T_world_camera) override {
    EXPECT_EQ(T_world_camera, at(acquired.back().translation().x() + drift));
    called('g');
    return entry(proposals);
  }
  std::optional<Decision> decide(const Pose&, std::span<const Candidate> candidates) override {
    EXPECT_EQ(candidates.size(), entry(proposals).candidates.size());
    called('d');
    return entry(decisions);
  }

  PlanningResult run(PlanningConfig config) {
    config.stop = stop.get_token();
    PlanningResult result = active_view_planning(at(0), *this, *this, *this, *this, config,
                                                 [this](const ViewRecord& record) {
                                                   EXPECT_EQ(record.index, observed++);
                                                   calls += '.';
                                                 });
    EXPECT_EQ(observed, result.views.size());
    return result;
  }

  std::size_t observed = 0;

 private:
  template <typename Entry>
  const Entry& entry(const std::vector<Entry>& script) const {
    return script[std::min(acquired.size(), script.size()) - 1];
  }
  void called(char what) {
    calls += what;
    const auto count = static_cast<std::size_t>(
        std::count_if(calls.begin(), calls.end(), [](char c) { return c != '.'; }));
    if (count == stop_after) stop.request_stop();
    if (count == throw_after) throw std::runtime_error("part");
  }
};

/// Progress that adds to the entropy and takes off the unknown voxels in each view.
std::vector<ModelProgress> steps(std::vector<std::pair<double, std::uint64_t>> values) {
  std::vector<ModelProgress> progress;
  for (const auto& [entropy, unknown] : values) progress.push_back({entropy, unknown, {}});
  return progress;
}

// Under what the scripts' decisions promise.
PlanningConfig low_limits() {
  PlanningConfig config;
  config.stop_gain = 0.15;
  config.stop_area = 0;
  config.broken_promises = 0;
  return config;
}

PlanningConfig never_idle(std::size_t max_views = 20) {
  PlanningConfig config = low_limits();
  config.idle_views = 0;
  config.max_views = max_views;
  return config;
}

TEST(Planning, StopsAtTheViewBudget) {
  for (const std::size_t budget : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    Script script;
    const PlanningResult result = script.run(never_idle(budget));
    EXPECT_EQ(result.reason, StopReason::max_views);
    EXPECT_EQ(result.views.size(), budget);
    EXPECT_FALSE(result.views.back().decision);
    EXPECT_TRUE(result.views.back().proposal.candidates.empty());
  }
  Script script;
  (void)script.run(never_idle(1));
  EXPECT_EQ(script.calls, "au.");  // nobody asks for a view that cannot be taken
  Script two;
  (void)two.run(never_idle(2));
  EXPECT_EQ(two.calls, "augd.au.");
}

TEST(Planning, RecordsWhatHappened) {
  Script script;
  script.progress = steps({{100, 1000}, {130, 800}, {125, 790}});
  script.proposals = {{{candidate(1), candidate(3)}, {{"taken", 2}}}, {{candidate(-1)}, {}}};
  script.decisions = {Decision{1, 12, 3, 0.5}, Decision{0, 4, 2, 0.25}};
  const PlanningResult result = script.run(never_idle(3));
  ASSERT_EQ(result.views.size(), 3U);
  const auto& [first, second, third] = std::tie(result.views[0], result.views[1], result.views[2]);

  EXPECT_EQ(first.T_world_camera, at(0));
  EXPECT_FALSE(first.chosen_as);
  EXPECT_TRUE(std::isnan(first.predicted_gain));
  EXPECT_TRUE(std::isnan(first.predicted_area));
  EXPECT_EQ(first.realised_gain, 100);
  EXPECT_EQ(first.travelled, 0);
  EXPECT_EQ(first.proposal.candidates.size(), 2U);
  EXPECT_EQ(first.proposal.dropped.at("taken"), 2U);
  ASSERT_TRUE(first.decision);
  EXPECT_EQ(first.decision->candidate, 1U);

  EXPECT_EQ(second.T_world_camera, at(3));
  ASSERT_TRUE(second.chosen_as);
  EXPECT_EQ(second.chosen_as->number, 7U);
  EXPECT_EQ(second.chosen_as->boundary_class, BoundaryClass::left);
  EXPECT_EQ(second.predicted_gain, 12);
  EXPECT_EQ(second.predicted_area, 0.5);
  EXPECT_EQ(second.realised_gain, 30);
  EXPECT_EQ(second.progress.unknown_voxels, 800U);
  EXPECT_EQ(second.travelled, 3);

  EXPECT_EQ(third.T_world_camera, at(-1));
  EXPECT_EQ(third.predicted_gain, 4);
  EXPECT_EQ(third.predicted_area, 0.25);
  EXPECT_EQ(third.realised_gain, -5);
  EXPECT_EQ(third.travelled, 7);
}

TEST(Planning, RecordsWhereTheMeasurementsWereTaken) {
  Script script;
  script.drift = 0.25;
  const PlanningResult result = script.run(never_idle(2));
  EXPECT_EQ(result.views[1].T_world_camera, at(3.25));
  EXPECT_EQ(result.views[1].chosen_as->T_world_camera, at(3));
  EXPECT_EQ(result.views[1].travelled, 3);
}

TEST(Planning, StopsWhenTheBestViewPromisesTooLittle) {
  Script script;
  script.decisions = {Decision{0, 9, 0.15}, Decision{0, 9, 0.1499}};
  const PlanningResult result = script.run(never_idle());
  EXPECT_EQ(result.reason, StopReason::gain);
  EXPECT_EQ(result.views.size(), 2U);
  ASSERT_TRUE(result.views.back().decision);
  EXPECT_EQ(result.views.back().decision->gain_per_voxel, 0.1499);
}

TEST(Planning, RelativeGainIsAShareOfTheFirstDecision) {
  PlanningConfig config = never_idle();
  config.stop_gain = 0.01;
  config.stop_gain_is_relative = true;
  Script script;
  // A policy may have no figure for its first choice.
  script.decisions = {Decision{0, 9, kNan}, Decision{0, 9, 2e-6}, Decision{0, 9, 2.1e-8},
                      Decision{0, 9, 1.9e-8}};
  const PlanningResult result = script.run(config);
  EXPECT_EQ(result.reason, StopReason::gain);
  EXPECT_EQ(result.views.size(), 4U);
}

TEST(Planning, StopsWhenNoCandidatePromisesEnoughArea) {
  PlanningConfig config = never_idle(9);
  config.stop_area = 0.25;
  Script script;
  // Of 2 m² of surface 0.5 on the mean of three; the chosen one's own area does not count.
  script.progress = {{100, 1000, {}, 2.0}};
  const auto promises = [](double best) { return Decision{0, 9, kNan, 0.0, best}; };
  script.decisions = {promises(0.1),  promises(0.1),  promises(1.4), promises(kNan),
                      promises(0.25), promises(0.75), promises(0.5), promises(0.2)};
  const PlanningResult result = script.run(config);
  EXPECT_EQ(result.reason, StopReason::area);
  EXPECT_EQ(result.views.size(), 8U);
  ASSERT_TRUE(result.views.back().decision);
  EXPECT_EQ(result.views.back().decision->best_area, 0.2);
  // The limit goes with the surface.
  script.acquired.clear();
  script.observed = 0;
  script.progress.push_back({100, 1000, {}, 0.5});
  EXPECT_EQ(script.run(config).reason, StopReason::max_views);
}

TEST(Planning, NoShareOfTheSurfaceOrNoAreaNeverStops) {
  for (const double share : {0.0, 0.5}) {
    for (const double best : {0.0, kNan}) {
      for (const double surface : {0.0, 2.0}) {
        PlanningConfig config = never_idle(5);
        config.stop_area = share;
        Script script;
        script.progress = {{100, 1000, {}, surface}};
        script.decisions = {Decision{0, 9, kNan, kNan, best}};
        const bool stops = share > 0 && best == 0.0 && surface > 0;
        EXPECT_EQ(script.run(config).reason, stops ? StopReason::area : StopReason::max_views);
      }
    }
  }
  EXPECT_EQ(PlanningConfig{}.stop_area, kStopArea);
  EXPECT_EQ(PlanningConfig{}.stop_gain, kStopGain);
}

// Under a fifth of what was promised, three times in a row: of new surface where both are known,
// else of entropy, and by neither of a policy that never stops for them.
TEST(Planning, StopsForPromisesThatAreNotKept) {
  struct Case {
    std::vector<double> came;  // after the first view
    std::size_t views;         // that the run has, of nine
  };
  const std::vector<Case> cases{{{0.19, 0.19, 0.19}, 4},
                                {{0.2, 0.19, 0.19, 0.1999}, 5},
                                {{0, 0, 0.2, 0, 0, 0.3, 0, 0}, 9},
                                {{0, kNan, 0, 0}, 5},  // nobody knows: it neither counts nor breaks
                                {{kNan, 0, 0, 0}, 5},
                                {{-1, -1, -1}, 4}};
  for (const Case& c : cases) {
    for (const char* by : {"area", "gain", "neither"}) {
      const bool of_area = *by == 'a', of_gain = *by == 'g';
      Script script;
      script.progress = {{100, 1000, {}, 1.0}};
      for (const double came : c.came) {
        ModelProgress next = script.progress.back();
        if (of_area) next.new_area = came;
        if (!of_area && !std::isnan(came)) next.entropy_removed += came;
        script.progress.push_back(next);
      }
      // A gain that is not held against anything where the area is.
      script.decisions = {of_area   ? Decision{0, 9, kNan, 1.0, 1.0}
                          : of_gain ? Decision{0, 1, 9, 1.0}
                                    : Decision{0, 1, kNan, 1.0}};
      PlanningConfig config = never_idle(9);
      config.broken_promises = 3;
      const bool is_known = std::none_of(c.came.begin(), c.came.end(), [](double v) {
        return std::isnan(v);  // the entropy is
      });
      if (of_gain && !is_known) continue;
      const PlanningResult result = script.run(config);
      const std::size_t views = *by == 'n' ? 9 : c.views;
      EXPECT_EQ(result.views.size(), views) << by << c.came.front();
      EXPECT_EQ(result.reason, views < 9 ? StopReason::promises : StopReason::max_views) << by;
    }
  }
  EXPECT_EQ(stop_reason_name(StopReason::promises), "promises");
}

TEST(Planning, NoCandidatesOrOutOfReach) {
  for (const bool some_left : {false, true}) {
    for (const std::size_t unreachable : {std::size_t{0}, std::size_t{4}}) {
      Script script;
      Proposal proposal;
      proposal.dropped = {{"collision", 9}};
      if (unreachable > 0) proposal.dropped[std::string(kUnreachable)] = unreachable;
      // The decision maker takes none of those that are left.
      if (some_left) proposal.candidates = {candidate(1)};
      script.proposals = {proposal};
      script.decisions = {std::nullopt};
      const PlanningResult result = script.run(never_idle());
      EXPECT_EQ(result.reason,
                unreachable > 0 ? StopReason::unreachable : StopReason::no_candidates);
      EXPECT_EQ(script.calls, some_left ? "augd." : "aug.");
      EXPECT_FALSE(result.views.back().decision);
      EXPECT_EQ(result.views.back().proposal.dropped.at("collision"), 9U);
    }
  }
  Script none_counted;
  none_counted.proposals = {{{}, {{std::string(kUnreachable), 0}}}};
  EXPECT_EQ(none_counted.run(never_idle()).reason, StopReason::no_candidates);
}

TEST(Planning, IdleViewsInARow) {
  PlanningConfig config = low_limits();
  config.idle_views = 2;
  config.idle_fraction = 0.01;
  struct Case {
    std::vector<ModelProgress> progress;
    std::size_t views;  // 9: the budget
  };
  const std::vector<Case> cases{
      // Both stand still.
      {steps({{100, 1000}}), 3},
      // Just under the two thresholds: 1 % of 100 and of 1000.
      {steps({{100, 1000}, {100.99, 991}, {101.5, 985}}), 3},
      // Entropy at its threshold, then unknown voxels at theirs: each keeps the run alive.
      {steps({{100, 1000},
              {101, 1000},
              {101, 990},
              {103, 990},
              {103, 970},
              {106, 970},
              {106, 950},
              {109, 950},
              {109, 930}}),
       9},
      // Not in a row: the second view is idle, the third is not, then two are.
      {steps({{100, 1000}, {100, 1000}, {150, 1000}, {150, 1000}, {150, 1000}}), 5},
      // Entropy may fall and unknown voxels run out.
      {steps({{100, 0}, {90, 0}, {80, 0}}), 3},
      // Nothing at all from the start: the first view itself is never idle.
      {steps({{0, 0}}), 3},
      // NaN says nothing about progress: the unknown voxels decide.
      {steps({{kNan, 1000}}), 3},
      {steps({{100, 1000}, {kNan, 1000}, {kNan, 1000}}), 3},
      {steps({{kNan, 1000}, {kNan, 900}, {kNan, 900}, {kNan, 900}}), 4},
  };
  std::size_t count = 0;
  for (const Case& c : cases) {
    config.max_views = 9;
    Script script;
    script.progress = c.progress;
    const PlanningResult result = script.run(config);
    EXPECT_EQ(result.views.size(), c.views) << count;
    EXPECT_EQ(result.reason, c.views == 9 ? StopReason::max_views : StopReason::idle) << count;
    ++count;
  }
  EXPECT_EQ(count, 9U);

  config.idle_views = 0;
  Script never;
  EXPECT_EQ(never.run(config).reason, StopReason::max_views);
}

TEST(Planning, StopsAtACoverage) {
  PlanningConfig config = never_idle();
  config.stop_coverage = 0.9;
  Script script;
  script.progress = {{1, 9, {}}, {2, 8, 0.89}, {3, 7, 0.9}};
  const PlanningResult result = script.run(config);
  EXPECT_EQ(result.reason, StopReason::coverage);
  EXPECT_EQ(result.views.size(), 3U);
  EXPECT_EQ(result.views.back().progress.coverage, 0.9);
}

TEST(Planning, EndsBetweenTheStepsWhenAsked) {
  struct Case {
    std::size_t stop_after;
    std::string calls;
    bool has_proposal, has_decision;
  };
  // What was measured goes into the model even if the end is asked for meanwhile.
  const std::vector<Case> cases{{1, "au.", false, false},      {2, "au.", false, false},
                                {3, "aug.", true, false},      {4, "augd.", true, true},
                                {5, "augd.au.", false, false}, {8, "augd.augd.", true, true}};
  for (const Case& c : cases) {
    Script script;
    script.stop_after = c.stop_after;
    const PlanningResult result = script.run(never_idle());
    EXPECT_EQ(result.reason, StopReason::interrupted) << c.stop_after;
    EXPECT_EQ(script.calls, c.calls);
    EXPECT_EQ(!result.views.back().proposal.candidates.empty(), c.has_proposal);
    EXPECT_EQ(result.views.back().decision.has_value(), c.has_decision);
  }
}

// All rules that could hold do; taking the first away shows the next.
TEST(Planning, TheOrderOfTheRules) {
  Script script;
  PlanningConfig config = low_limits();
  config.max_views = 3;
  config.idle_views = 1;
  config.stop_coverage = 0.5;
  const auto reason_in_view_three = [](Script s, PlanningConfig c) {
    s.stop = std::stop_source();  // a copy would share the request
    const PlanningResult result = s.run(c);
    EXPECT_EQ(result.views.size(), 3U);
    return result.reason;
  };
  script.progress = {{1, 9, 0.0}, {5, 5, 0.0}, {5, 5, 1.0}};
  script.proposals = {{{candidate(1)}, {}}, {{candidate(1)}, {}}, {{}, {{"unreachable", 1}}}};
  script.decisions = {Decision{0, 1, 1}, Decision{0, 1, 1}, Decision{0, 1, 0}};
  script.stop_after = 10;
  EXPECT_EQ(reason_in_view_three(script, config), StopReason::interrupted);
  script.stop_after = 0;
  EXPECT_EQ(reason_in_view_three(script, config), StopReason::coverage);
  config.stop_coverage.reset();
  EXPECT_EQ(reason_in_view_three(script, config), StopReason::max_views);
  config.max_views = 4;
  EXPECT_EQ(reason_in_view_three(script, config), StopReason::idle);
  config.idle_views = 2;
  EXPECT_EQ(reason_in_view_three(script, config), StopReason::unreachable);
  script.proposals.back().dropped.clear();
  EXPECT_EQ(reason_in_view_three(script, config), StopReason::no_candidates);
  script.proposals.back().candidates = {candidate(1)};
  config.stop_area = 0.5;
  for (ModelProgress& progress : script.progress) progress.surface_area = 1;
  for (auto& decision : script.decisions) decision->best_area = 0.1;
  EXPECT_EQ(reason_in_view_three(script, config), StopReason::gain);
  script.decisions.back()->gain_per_voxel = 1;
  EXPECT_EQ(reason_in_view_three(script, config), StopReason::area);
}

TEST(Planning, ExceptionsPassThrough) {
  for (std::size_t call = 1; call <= 8; ++call) {
    Script script;
    script.throw_after = call;
    EXPECT_THROW((void)script.run(never_idle()), std::runtime_error);
    EXPECT_EQ(script.observed, call <= 4 ? 0U : 1U);
  }
}

TEST(Planning, RefusesWhatMakesNoSense) {
  const auto refuse = [](const std::string& part, const auto& change) {
    PlanningConfig config;
    change(config);
    expect_error(ErrorCode::invalid_argument, part, [&] {
      Script script;
      (void)script.run(config);
    });
  };
  refuse("max_views must be at least 1, not 0", [](PlanningConfig& c) { c.max_views = 0; });
  refuse("stop_gain must be finite", [](PlanningConfig& c) { c.stop_gain = kNan; });
  refuse("stop_area must be finite", [](PlanningConfig& c) { c.stop_area = INFINITY; });
  refuse("idle_fraction", [](PlanningConfig& c) { c.idle_fraction = INFINITY; });
  refuse("stop_coverage", [](PlanningConfig& c) { c.stop_coverage = kNan; });
  Script wrong;
  wrong.decisions = {Decision{2, 1, 1}};
  expect_error(ErrorCode::invalid_argument,
               "candidate 2; it must be less than the number of candidates, 2",
               [&wrong] { (void)wrong.run(never_idle()); });
}

// The rules by themselves: what they remember is all they need to go on.
TEST(StopRules, GoOnFromWhatTheyRemember) {
  std::mt19937 random(5);
  const auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
  const auto value = [&] { return std::uniform_real_distribution(0.0, 2.0)(random); };
  int stops = 0, steps = 0;
  for (int run = 0; run < 200; ++run) {
    PlanningConfig config;
    config.max_views = 12;
    config.idle_views = 2;
    config.stop_gain = chance(0.5) ? 0.2 : 0.05;
    config.stop_gain_is_relative = chance(0.5);
    config.stop_area = chance(0.5) ? 0.2 : 0.0;
    config.broken_promises = 2;
    StopRules whole(config), parts(config);
    ModelProgress progress{0, 1000, {}, 1.0};
    for (;;) {
      if (chance(0.8)) progress.entropy_removed += value(), progress.unknown_voxels -= 5;
      progress.new_area = chance(0.8) ? 0.1 * value() : std::numeric_limits<double>::quiet_NaN();
      DecisionMaking::Decision decision;
      decision.area = decision.gain = 0.4 * value();
      if (chance(0.7)) decision.gain_per_voxel = value();
      if (chance(0.7)) decision.best_area = 0.3 * value();
      if (chance(0.7)) decision.worth = value() - 0.1;
      const auto a = whole.after_view(progress);
      parts = StopRules(config, parts.memory());
      const auto b = parts.after_view(progress);
      ASSERT_EQ(a, b);
      parts = StopRules(config, parts.memory());
      const auto c = whole.after_decision(decision, {}, progress.surface_area);
      const auto d = parts.after_decision(decision, {}, progress.surface_area);
      ASSERT_EQ(c, d);
      ++steps;
      if (a || c) {
        ++stops;
        break;
      }
    }
  }
  EXPECT_EQ(stops, 200);
  EXPECT_GT(steps, 600);
}

}  // namespace
}  // namespace viewgain
