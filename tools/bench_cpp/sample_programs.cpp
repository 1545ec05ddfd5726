#include "sample_programs.hpp"

#include <random>

#include "viapoint/core/units.hpp"

namespace viapoint::bench {
namespace {

MotionProgram empty_program(const RobotModel& robot, const JointVector& start) {
  MotionProgram program;
  program.robot = robot.name();
  program.robot_fingerprint = robot.fingerprint();
  program.start = start;
  return program;
}

void add(MotionProgram& program, PtpMove move, Zone zone) {
  Step step;
  step.what = std::move(move);
  step.options.zone = zone;
  program.steps.push_back(std::move(step));
}

void add(MotionProgram& program, LinMove move, Zone zone) {
  Step step;
  step.what = std::move(move);
  step.options.zone = zone;
  program.steps.push_back(std::move(step));
}

}  // namespace

MotionProgram random_ptp(const RobotModel& robot, int moves, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0.2, 0.8);
  const JointLimits& limits = robot.limits();
  const auto point = [&] {
    JointVector q(limits.joints());
    for (int i = 0; i < limits.joints(); ++i) {
      q[i] = limits.position_min[i] +
             share(random) * (limits.position_max[i] - limits.position_min[i]);
    }
    return q;
  };
  const JointVector start = point();
  MotionProgram program = empty_program(robot, start);
  for (int i = 0; i + 1 < moves; ++i) {
    add(program, PtpMove{JointTarget{point()}}, {ZoneKind::kJointDeviation, 0.05});
  }
  add(program, PtpMove{JointTarget{start}}, {});
  return program;
}

MotionProgram random_lin(const RobotModel& robot, int moves, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  // Elbow bent, wrist away from its singularity.
  JointVector start(6);
  start << 0.0, 0.4, 0.0, 0.3, 0.9, 0.2;
  const Pose home = robot.forward().pose(start);
  MotionProgram program = empty_program(robot, start);
  for (int i = 0; i < moves; ++i) {
    Pose pose = home;
    if (i + 1 < moves) {
      pose.translation() += 0.15 * Eigen::Vector3d(unit(random), unit(random), unit(random));
      pose.rotate(
          rotation_exp(10 * kDegree * Eigen::Vector3d(unit(random), unit(random), unit(random))));
    }
    add(program, LinMove{PoseTarget{pose}}, i + 1 < moves ? Zone{ZoneKind::kRadius, 0.02} : Zone{});
  }
  return program;
}

RobotPtr walking_robot() {
  JointLimits limits;
  limits.velocity.resize(6);
  limits.velocity << 2.1, 2.1, 2.6, 4.0, 4.0, 6.0;
  limits.acceleration = 10.0 * limits.velocity;
  limits.jerk = 100.0 * limits.velocity;
  limits.position_min = JointVector::Constant(6, -1e3);
  limits.position_max = JointVector::Constant(6, 1e3);
  limits.coupling.resize(0, 6);
  limits.coupling_lower.resize(0);
  limits.coupling_upper.resize(0);
  return RobotModel::joint_robot(limits);
}

JointVector random_walk_step(int joints, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> length(0.1, 0.6);
  JointVector direction(joints);
  for (int i = 0; i < joints; ++i) direction[i] = normal(random);
  return length(random) * direction.normalized();
}

MotionProgram random_walk(const RobotModel& robot, int points, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  JointVector q = JointVector::Zero(robot.joints());
  MotionProgram program = empty_program(robot, q);
  for (int k = 1; k < points; ++k) {
    q += random_walk_step(robot.joints(), random);
    add(program, PtpMove{JointTarget{q}}, {});
  }
  return program;
}

}  // namespace viapoint::bench
