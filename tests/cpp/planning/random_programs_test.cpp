// Random programs of mixed moves: each ends in a certified motion or a named error.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "planning/planner_fixture.hpp"

namespace viapoint {
namespace {

using namespace testing_planner;

/// How many programs for which arm: numerical inverse kinematics is slow at listing branches.
struct Sweep {
  const char* robot;
  unsigned programs;
};

class RandomPrograms : public testing::TestWithParam<Sweep> {};

JointVector random_joints(const JointLimits& limits, std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> uniform(-reach, reach);
  JointVector q(limits.joints());
  for (int i = 0; i < limits.joints(); ++i) {
    const double middle = 0.5 * (limits.position_min[i] + limits.position_max[i]);
    const double half = 0.5 * (limits.position_max[i] - limits.position_min[i]);
    q[i] = middle + uniform(random) * half;
  }
  return q;
}

Zone random_zone(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  switch (random() % 4) {
    case 0:
      return {};
    case 1:
      return {ZoneKind::kRadius, std::pow(10.0, -5.0 * uniform(random))};
    case 2:
      return {ZoneKind::kDeviation, std::pow(10.0, -1.0 - 5.0 * uniform(random))};
    default:
      return {ZoneKind::kJointDeviation, std::pow(10.0, -6.0 * uniform(random))};
  }
}

/// An arc, a turn or a spline about the joints `q`; mostly near enough to be followed.
decltype(Step::what) random_curve_move(const RobotModel& robot, const JointVector& near,
                                       const JointVector& q, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, random() % 5 == 0 ? 0.5 : 0.05);
  const auto offset = [&]() -> Eigen::Vector3d {
    const double x = normal(random);
    const double y = normal(random);
    return {x, y, normal(random)};
  };
  const Pose end = robot.forward().pose(q);
  const auto orientation = static_cast<Orientation>(random() % 7);
  switch (random() % 3) {
    case 0: {
      Pose via = end;
      via.translation() += offset();
      return CircMove{PoseTarget{via}, PoseTarget{end}, orientation};
    }
    case 1: {
      TurnMove move;
      if (random() % 4 != 0) move.center = end.translation() + offset();
      if (random() % 2 == 0) move.axis = Eigen::Vector3d::UnitZ();
      move.angle = 40.0 * normal(random);
      if (random() % 2 == 0) move.pitch = normal(random);
      move.orientation = orientation;
      return move;
    }
    default: {
      SplineMove move;
      for (size_t k = random() % 4; k > 0; --k) {
        JointVector point = 0.7 * q + 0.3 * near;
        for (double& value : point) value += normal(random);
        move.points.emplace_back(PoseTarget{robot.forward().pose(point)});
      }
      move.points.emplace_back(PoseTarget{end});
      move.kind = static_cast<SplineKind>(random() % 4);
      move.space = random() % 3 == 0 ? SplineSpace::kJoint : SplineSpace::kTool;
      move.orientation = orientation;
      return move;
    }
  }
}

MotionProgram random_program(const RobotModel& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  JointVector q = random_joints(robot.limits(), random, 0.5);
  Script script(robot, q);
  const size_t moves = 1 + random() % 4;
  for (size_t i = 0; i < moves; ++i) {
    // Near targets mostly, so that many straight lines exist; now and then far, tiny or nowhere.
    double step = 0.15;
    if (random() % 4 == 0) step = 1.0;
    if (random() % 6 == 0) step = std::pow(10.0, -8.0 * uniform(random));
    if (random() % 30 == 0) step = 0.0;
    q = (1.0 - step) * q + step * random_joints(robot.limits(), random, 0.8);
    MoveOptions options;
    options.zone = random_zone(random);
    if (random() % 3 == 0) options.scale = std::pow(10.0, -4.0 * uniform(random));
    if (random() % 3 == 0) options.speed = std::pow(10.0, 1.0 - 5.0 * uniform(random));
    if (random() % 3 == 0) options.acceleration = std::pow(10.0, 1.0 - 4.0 * uniform(random));
    if (random() % 5 == 0) options.angular_speed = std::pow(10.0, 1.0 - 4.0 * uniform(random));
    if (random() % 5 == 0) {
      options.angular_acceleration = std::pow(10.0, 2.0 - 4.0 * uniform(random));
    }
    if (random() % 3 == 0) {
      script.add(random_curve_move(robot, script.program().start, q, random), options);
    } else if (random() % 2 == 0) {
      script.add(PtpMove{JointTarget{q}}, options);
    } else if (random() % 6 == 0) {
      script.add(LinMove{PositionTarget{robot.forward().pose(q).translation()}}, options);
    } else {
      constexpr std::array kOfLines = {Orientation::kLeast, Orientation::kWrist,
                                       Orientation::kFixed, Orientation::kSpin};
      script.add(LinMove{PoseTarget{robot.forward().pose(q)}, kOfLines[random() % 4]}, options);
    }
    if (random() % 8 == 0) script.add(Wait{random() % 3 == 0 ? 0.0 : 0.1 * uniform(random)});
    for (size_t k = random() % 8 == 0 ? 1 + random() % 9 : 0; k > 0; --k) {
      script.add(SetOutput{static_cast<int>(k), random() % 2 == 0});
    }
  }
  return script.program();
}

TEST_P(RandomPrograms, EndInACertifiedMotionOrANamedError) {
  const RobotPtr arm = robot(GetParam().robot);
  const MotionPlanner planner(arm);
  int planned = 0;
  for (unsigned seed = 0; seed < GetParam().programs; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const MotionProgram program = random_program(*arm, random);
    const Report report = planner.check(program);
    for (const Problem& problem : report.problems) {
      ASSERT_NE(problem.code, ErrorCode::kInternal) << problem.describe();
      ASSERT_NE(problem.code, ErrorCode::kDiscontinuous) << problem.describe();
      // As a warning: a speed that was asked for and cannot be kept.
      ASSERT_TRUE(problem.code != ErrorCode::kVelocityLimit ||
                  problem.severity == Severity::kWarning)
          << problem.describe();
      ASSERT_NE(problem.code, ErrorCode::kAccelerationLimit) << problem.describe();
      ASSERT_NE(problem.code, ErrorCode::kJerkLimit) << problem.describe();
      ASSERT_FALSE(problem.message.empty());
      // Only of a program as a whole there is no line.
      ASSERT_TRUE(problem.line.has_value() || problem.code == ErrorCode::kEmptyProgram)
          << problem.describe();
    }
    if (!report.ok()) {
      ASSERT_THROW((void)planner.plan(program), MotionError);
      continue;
    }
    const PlannedMotion motion = planner.plan(program);
    ASSERT_TRUE(motion.trajectory.certificate().holds());
    ++planned;
    // Independent of the certificate: dense samples keep every limit.
    const Trajectory& trajectory = motion.trajectory;
    for (int k = 0; k <= 500; ++k) {
      const JointState state = trajectory.at(trajectory.duration() * k / 500.0);
      ASSERT_TRUE(arm->limits().contains(state.q, 1e-9));
      for (int i = 0; i < arm->joints(); ++i) {
        ASSERT_LE(std::abs(state.qd[i]), arm->limits().velocity[i] * (1 + 1e-6));
        ASSERT_LE(std::abs(state.qdd[i]), arm->limits().acceleration[i] * (1 + 1e-6));
        ASSERT_LE(std::abs(state.qddd[i]), arm->limits().jerk[i] * (1 + 1e-6));
      }
    }
  }
  // The sweep must mean something: a good part of the programs run.
  EXPECT_GE(planned, static_cast<int>(GetParam().programs) / 5);
}

INSTANTIATE_TEST_SUITE_P(Robots, RandomPrograms,
                         testing::Values(Sweep{"puma560", 200}, Sweep{"scara", 60},
                                         Sweep{"ur5e", 15}, Sweep{"panda", 15}),
                         [](const auto& instance) { return std::string(instance.param.robot); });

}  // namespace
}  // namespace viapoint
