// Moves that take long, by a low speed or acceleration of the tool or by a small share of the
// limits: how long they last does not decide how much work they are.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "planning/planner_fixture.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;

constexpr double kWay = 0.2;
/// Of the pieces of a motion: they follow from the path, and a few more from how it speeds up.
constexpr size_t kMostPieces = 300;

class SlowMoves : public ::testing::TestWithParam<Orientation> {
 protected:
  Trajectory line(const MoveOptions& options) const {
    const JointVector home = degrees({0, -90, 90, -90, -90, 0});
    Pose goal = arm_->forward().pose(home);
    goal.translation() += Eigen::Vector3d(0.0, kWay, 0.0);
    goal.linear() = goal.linear() * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());
    Script script(*arm_, home);
    script.add(LinMove{PoseTarget{goal}, GetParam()}, options);
    return MotionPlanner(arm_).plan(script.program()).trajectory;
  }
  static void expect_little_work(const Trajectory& motion) {
    EXPECT_LT(motion.pieces().size(), kMostPieces);
    EXPECT_TRUE(motion.certificate().holds());
  }

  RobotPtr arm_ = robot("ur5e");
};

TEST_P(SlowMoves, TakeTheTimeOfTheirSpeed) {
  for (int decade = 1; decade <= 6; ++decade) {
    SCOPED_TRACE(decade);
    MoveOptions options;
    options.speed = std::pow(10.0, -decade);
    const Trajectory motion = line(options);
    expect_little_work(motion);
    const double steady = kWay / *options.speed;
    EXPECT_GE(motion.duration(), steady);
    EXPECT_LE(motion.duration(), 1.04 * steady + 0.5);
  }
}

TEST_P(SlowMoves, TakeTheTimeOfTheirAcceleration) {
  for (int decade = 1; decade <= 6; ++decade) {
    SCOPED_TRACE(decade);
    MoveOptions options;
    options.acceleration = std::pow(10.0, -decade);
    const Trajectory motion = line(options);
    expect_little_work(motion);
    // Half the way faster and faster, half of it slower.
    const double least = 2.0 * std::sqrt(kWay / *options.acceleration);
    EXPECT_GE(motion.duration(), least);
    EXPECT_LE(motion.duration(), 1.05 * least + 0.5);
  }
}

TEST_P(SlowMoves, TakeTheTimeOfBoth) {
  for (int decade = 1; decade <= 6; ++decade) {
    SCOPED_TRACE(decade);
    MoveOptions options;
    options.speed = std::pow(10.0, -decade);
    options.acceleration = std::pow(10.0, 1 - decade);
    const Trajectory motion = line(options);
    expect_little_work(motion);
    const double least = kWay / *options.speed + *options.speed / *options.acceleration;
    EXPECT_GE(motion.duration(), (1.0 - 1e-9) * least);
    EXPECT_LE(motion.duration(), 1.02 * least + 0.5);
  }
}

TEST_P(SlowMoves, AreAsMuchSlowerAsTheirShareOfTheLimits) {
  double quicker = 0.0;
  for (int decade = 1; decade <= 4; ++decade) {
    SCOPED_TRACE(decade);
    MoveOptions options;
    options.scale = std::pow(10.0, -decade);
    options.speed = 10.0;  // beyond what the joints can do, but looked at
    const Trajectory motion = line(options);
    expect_little_work(motion);
    // Velocity rules more and more, acceleration and jerk less and less.
    EXPECT_GT(motion.duration(), quicker);
    if (decade > 2) {
      EXPECT_NEAR(motion.duration(), 10.0 * quicker, 0.5 * quicker);
    }
    quicker = motion.duration();
  }
}

INSTANTIATE_TEST_SUITE_P(Orientations, SlowMoves,
                         ::testing::Values(Orientation::kLeast, Orientation::kFixed),
                         [](const auto& instance) {
                           return std::string(instance.param == Orientation::kLeast ? "Least"
                                                                                    : "Fixed");
                         });

}  // namespace
}  // namespace viapoint
