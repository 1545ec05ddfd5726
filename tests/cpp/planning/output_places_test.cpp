// Outputs at a distance along the path or a time on the clock from a point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "planning/planner_fixture.hpp"
#include "planning/stream_fixture.hpp"
#include "problem_count.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/planning/stream_planner.hpp"

namespace viapoint {
namespace {

using testing_planner::Played;
using testing_planner::robot;
using testing_planner::Script;

JointVector home() { return testing_planner::degrees({0, -90, 90, -90, -90, 0}); }

/// A change as it is in the pieces.
struct Found {
  int output = 0;
  bool value = false;
  double time = 0.0;
  double at = 0.0;       ///< nominal [s]
  Eigen::Vector3d tool;  ///< [m]
  double way = 0.0;      ///< of the tool since the beginning [m]
};

class Outputs : public testing::Test {
 protected:
  [[nodiscard]] Eigen::Vector3d tool(const JointVector& q) const {
    return arm_->fk(q).translation();
  }

  /// Chords of a thousandth of each piece.
  [[nodiscard]] double way(const TrajectoryPiece& piece) const {
    constexpr int kChords = 200;
    double sum = 0.0;
    Eigen::Vector3d before = tool(piece.at(0.0).q);
    for (int k = 1; k <= kChords; ++k) {
      const Eigen::Vector3d now = tool(piece.at(k * piece.duration / kChords).q);
      sum += (now - before).norm();
      before = now;
    }
    return sum;
  }

  [[nodiscard]] std::vector<Found> changes(const std::vector<TrajectoryPiece>& pieces) const {
    std::vector<Found> found;
    double time = 0.0;
    double travelled = 0.0;
    for (const TrajectoryPiece& piece : pieces) {
      for (int i = 0; i < piece.outputs; ++i) {
        const OutputChange& change = piece.output[static_cast<size_t>(i)];
        found.push_back(
            {change.index, change.value, change.time, time, tool(piece.at(0.0).q), travelled});
      }
      time += piece.duration;
      travelled += way(piece);
    }
    return found;
  }

  [[nodiscard]] static Found of(const std::vector<Found>& all, int output) {
    const auto at = std::ranges::find(all, output, &Found::output);
    EXPECT_NE(at, all.end()) << "output " << output;
    return at == all.end() ? Found{} : *at;
  }

  [[nodiscard]] static Pose moved(Pose pose, double x, double y, double z) {
    pose.translation() += Eigen::Vector3d(x, y, z);
    return pose;
  }

  RobotPtr arm_ = robot("ur5e");
  MotionPlanner planner_{arm_};
  Pose begin_ = arm_->fk(home());
};

TEST_F(Outputs, StandAtTheirDistanceFromAStop) {
  Script script(*arm_, home());
  const Pose corner = moved(begin_, 0.0, 0.2, 0.0);
  script.movel(corner);
  script.add(SetOutput{1, true, -0.02}).add(SetOutput{2, true}).add(Wait{0.1});
  script.add(SetOutput{3, true, 0.03}).add(SetOutput{4, true, -0.05});
  script.movel(moved(corner, 0.0, 0.0, 0.1));
  script.add(SetOutput{5, true, -0.01});
  constexpr double kLine = 5e-5;  // the line itself is no straighter
  const PlannedMotion motion = planner_.plan(script.program());
  const std::vector<Found> all = changes(motion.trajectory.pieces());
  ASSERT_EQ(all.size(), 5U);
  const Eigen::Vector3d point = corner.translation();
  EXPECT_NEAR((of(all, 1).tool - (point - Eigen::Vector3d(0, 0.02, 0))).norm(), 0.0, kLine);
  EXPECT_NEAR((of(all, 2).tool - point).norm(), 0.0, kLine);
  EXPECT_NEAR((of(all, 3).tool - (point + Eigen::Vector3d(0, 0, 0.03))).norm(), 0.0, kLine);
  EXPECT_NEAR((of(all, 4).tool - (point - Eigen::Vector3d(0, 0.05, 0))).norm(), 0.0, kLine);
  EXPECT_NEAR((of(all, 5).tool - (point + Eigen::Vector3d(0, 0, 0.09))).norm(), 0.0, kLine);
  EXPECT_TRUE(motion.trajectory.certificate().holds());
}

TEST_F(Outputs, CountInACornerFromThePlaceThatIsNearestToThePoint) {
  for (const bool jointwise : {false, true}) {
    SCOPED_TRACE(jointwise);
    Script script(*arm_, home());
    const Pose corner = moved(begin_, 0.0, 0.2, 0.0);
    const Pose end = moved(corner, 0.0, 0.05, 0.15);
    const Zone zone{ZoneKind::kRadius, 0.03};
    const JointVector q =
        planner_.plan(Script(*arm_, home()).movel(corner).program()).trajectory.at(1e9).q;
    jointwise ? script.movej(q, zone) : script.movel(corner, zone);
    script.add(SetOutput{1, true, -0.05}).add(SetOutput{2, true}).add(SetOutput{3, true, 0.06});
    script.movel(end);
    const PlannedMotion motion = planner_.plan(script.program());
    ASSERT_FALSE(motion.corners.at(0).stopped) << motion.corners.at(0).reason;
    const std::vector<Found> all = changes(motion.trajectory.pieces());
    ASSERT_EQ(all.size(), 3U);
    double nearest = 1e9;
    for (double t = 0.0; t < motion.trajectory.duration(); t += 1e-4) {
      nearest = std::min(nearest, (tool(motion.trajectory.at(t).q) - corner.translation()).norm());
    }
    EXPECT_GT(nearest, 1e-3);
    EXPECT_NEAR((of(all, 2).tool - corner.translation()).norm(), nearest, 1e-8);
    EXPECT_NEAR(of(all, 2).way - of(all, 1).way, 0.05, 1e-6);
    EXPECT_NEAR(of(all, 3).way - of(all, 2).way, 0.06, 1e-6);
  }
}

TEST_F(Outputs, KeepTheirTimesAndTheArmRestsForThoseAfterTheEnd) {
  Script script(*arm_, home());
  script.movel(moved(begin_, 0.0, 0.2, 0.0));
  script.add(SetOutput{1, true, 0.0, -0.05}).add(SetOutput{2, true, -0.02, -0.01});
  script.movel(begin_);
  script.add(SetOutput{1, false, 0.0, 0.25});
  const PlannedMotion motion = planner_.plan(script.program());
  const std::vector<Found> all = changes(motion.trajectory.pieces());
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(of(all, 1).time, -0.05);
  EXPECT_EQ(of(all, 2).time, -0.01);
  EXPECT_EQ(all.back().time, 0.25);
  EXPECT_GE(motion.trajectory.duration(), all.back().at + 0.25 - 1e-12);
  EXPECT_LE(motion.trajectory.duration(), all.back().at + 0.26);
}

TEST_F(Outputs, AreRefusedADistanceThatTheirMoveHasNot) {
  const auto refused = [&](double distance, double limit) {
    SCOPED_TRACE(distance);
    Script script(*arm_, home());
    script.movel(moved(begin_, 0.0, 0.2, 0.0)).movel(moved(begin_, 0.0, 0.2, 0.1));
    script.add(SetOutput{1, true, distance});
    script.movel(moved(begin_, 0.0, 0.0, 0.1));
    const Report report = planner_.check(script.program());
    ASSERT_EQ(report.problems.size(), 1U) << report.describe();
    const Problem& problem = report.problems.front();
    EXPECT_EQ(problem.code, ErrorCode::kBadArgument);
    EXPECT_EQ(problem.line, 3);
    EXPECT_NEAR(problem.limit.value_or(-1.0), limit, 1e-5);
  };
  refused(-0.11, 0.1);
  refused(0.21, 0.2);
  Script first(*arm_, home());
  first.add(SetOutput{1, true, -0.01}).movel(moved(begin_, 0.0, 0.2, 0.0));
  EXPECT_FALSE(planner_.check(first.program()).ok());
  Script last(*arm_, home());
  last.movel(moved(begin_, 0.0, 0.2, 0.0)).add(SetOutput{1, true, 0.01});
  EXPECT_FALSE(planner_.check(last.program()).ok());
}

TEST_F(Outputs, AreRefusedWhereOneWouldUndoTheOther) {
  const auto refused = [&](const SetOutput& before, const SetOutput& after) {
    Script script(*arm_, home());
    script.movel(moved(begin_, 0.0, 0.2, 0.0)).add(before).add(after).movel(begin_);
    const Report report = planner_.check(script.program());
    EXPECT_FALSE(report.ok());
    EXPECT_EQ(report.problems.front().line, 3) << report.describe();
  };
  refused({1, true, 0.02}, {1, false, -0.02});
  refused({1, true, 0.0, 0.1}, {1, false});
  Script apart(*arm_, home());
  apart.movel(moved(begin_, 0.0, 0.2, 0.0)).add(SetOutput{1, true, 0.02});
  apart.add(SetOutput{2, false, -0.02}).movel(begin_);
  EXPECT_TRUE(planner_.check(apart.program()).ok());
}

TEST_F(Outputs, AreRefusedWhatNothingCanKeep) {
  const auto refused = [](const RobotPtr& arm, const JointVector& start, SetOutput output) {
    Script script(*arm, start);
    script.add(output);
    script.movej(start + JointVector::Constant(start.size(), 0.01));
    EXPECT_FALSE(MotionPlanner(arm).check(script.program()).ok());
  };
  refused(arm_, home(), {1, true, 0.0, 2.1});
  refused(arm_, home(), {1, true, 0.0, std::nan("")});
  refused(arm_, home(), {1, true, std::nan("")});
  refused(RobotModel::joint_robot(arm_->limits()), home(), {1, true, 0.01});
}

TEST_F(Outputs, WaitsForInputsAreRests) {
  Script script(*arm_, home());
  script.movel(moved(begin_, 0.0, 0.1, 0.0), {ZoneKind::kRadius, 0.02});
  script.add(WaitInput{5, false, 1.5}).movel(begin_).add(WaitInput{6, true, std::nullopt});
  const PlannedMotion motion = planner_.plan(script.program());
  const Trajectory& trajectory = motion.trajectory;
  ASSERT_EQ(trajectory.waits().size(), 2U);
  const TrajectoryPiece& first = trajectory.pieces()[trajectory.waits()[0]];
  EXPECT_EQ(first.wait.input, 5);
  EXPECT_FALSE(first.wait.value);
  EXPECT_EQ(first.wait.timeout, 1.5);
  EXPECT_EQ(first.move, 1);
  EXPECT_TRUE(trajectory.at(trajectory.start_of(trajectory.waits()[0])).qd.isZero(1e-9));
  EXPECT_TRUE(std::isinf(trajectory.pieces()[trajectory.waits()[1]].wait.timeout));
  for (const WaitInput& wrong : {WaitInput{64, true, 1.0}, WaitInput{-1, true, 1.0},
                                 WaitInput{1, true, 0.0}, WaitInput{1, true, std::nan("")}}) {
    Script refused(*arm_, home());
    refused.add(wrong).movel(begin_);
    EXPECT_FALSE(planner_.check(refused.program()).ok());
  }
}

/// Lines to and fro, rounded or not, each with outputs near its end and after it.
Script random_script(std::mt19937& random, const RobotPtr& arm, const Pose& begin) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Script script(*arm, home());
  Pose at = begin;
  for (int move = 0; move < 20; ++move) {
    at = begin;
    at.translation() +=
        Eigen::Vector3d(uniform(-0.1, 0.1), uniform(-0.1, 0.1), move % 2 == 0 ? 0.1 : -0.1);
    script.movel(at, random() % 3 == 0 ? Zone{} : Zone{ZoneKind::kRadius, 0.02});
    script.add(SetOutput{3 * move % 60, true, uniform(-0.04, 0.0)});
    script.add(SetOutput{(3 * move + 1) % 60, true, uniform(0.0, 0.04)});
    script.add(SetOutput{(3 * move + 2) % 60, true, 0.0, uniform(0.0, 0.1)});
  }
  script.movel(begin);
  return script;
}

TEST_F(Outputs, StandAtTheSamePlacesInAStream) {
  for (unsigned seed = 0; seed < problems(10U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Script script = random_script(random, arm_, begin_);
    const auto whole = changes(planner_.plan(script.program()).trajectory.pieces());
    StreamPlanner stream(arm_, script.program());
    stream.end();
    Played played(arm_->limits());
    while (auto chunk = stream.next()) played.add(*chunk);
    played.finish();
    EXPECT_EQ(played.problem, "");
    const auto parts = changes(played.pieces);
    ASSERT_EQ(parts.size(), whole.size());
    for (const Found& change : whole) {
      const Found found = of(parts, change.output);
      EXPECT_EQ(found.value, change.value);
      EXPECT_EQ(found.time, change.time);
      EXPECT_NEAR((found.tool - change.tool).norm(), 0.0, 1e-6) << "output " << change.output;
    }
  }
}

}  // namespace
}  // namespace viapoint
