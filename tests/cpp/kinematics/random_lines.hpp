/// @file
/// Straight lines of the tool at random, that an arm can hold at every pose.
#pragma once

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint::testing {

struct Line {
  std::vector<Pose> poses;
  JointVector start;  ///< near which the first pose is to be solved
};

/// The joint that stretches the wrist where it is 0; the shoulder's for the Panda, whose wrist can
/// only touch that place.
struct LineArm {
  const char* name;
  int singular_joint;
};
inline constexpr LineArm kLineArms[] = {{"puma560", 4}, {"ur5e", 4}, {"iiwa14", 5}, {"panda", 1}};
inline constexpr int kLineSteps = 200;

/// Poses of a line through the one at q in the middle: 0.1 to 0.6 m long, turned by up to 1.2 rad.
/// Half of them have that pose among theirs to the last bit, the others pass it between two.
/// @return nothing where some pose of it has no solution within the limits
inline std::optional<Line> line_through(const RobotModel& robot, const JointVector& q, int steps,
                                        std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto direction = [&] {
    return Eigen::Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
  };
  const Pose middle = robot.forward().pose(q);
  const Eigen::Vector3d way = direction() * (0.05 + 0.25 * share(generator));
  const Eigen::Vector3d turn = direction() * (0.6 * share(generator));
  const double offset = generator() % 2 == 0 ? 0.0 : (share(generator) - 0.5) * 2.0 / kLineSteps;
  Line line;
  line.start = q;
  for (int i = 0; i <= steps; ++i) {
    const double s = 2.0 * i / steps - 1.0 + offset;
    Pose pose = middle;
    pose.translation() += s * way;
    pose.linear() = rotation_exp(s * turn) * middle.linear();
    try {
      (void)robot.inverse().solve_near(pose, q);
    } catch (const MotionError&) {
      return std::nullopt;
    }
    line.poses.push_back(pose);
  }
  return line;
}

/// @param through whether the middle is to be singular
/// @param steps a multiple of kLineSteps; the same seed gives the same line with finer steps
inline Line random_line(const RobotModel& robot, int singular_joint, bool through,
                        std::uint64_t seed, int steps = kLineSteps) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    std::mt19937_64 generator(1000 * seed + attempt);
    JointVector q(robot.joints());
    for (int i = 0; i < robot.joints(); ++i) {
      q[i] = std::uniform_real_distribution<double>(robot.limits().position_min[i],
                                                    robot.limits().position_max[i])(generator);
    }
    if (through) q[singular_joint] = 0.0;
    std::mt19937_64 again = generator;
    if (!line_through(robot, q, kLineSteps, generator)) continue;
    if (std::optional<Line> line = line_through(robot, q, steps, again)) return *std::move(line);
  }
}

}  // namespace viapoint::testing
