/// @file
/// Random tool curves of every kind that start where an arm stands.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "path/teaching_arms.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/spline.hpp"
#include "viapoint/path/task_curve.hpp"

namespace viapoint::testing {

inline Eigen::Vector3d random_vector(std::mt19937& random, double size) {
  std::normal_distribution<double> normal(0.0, size);
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

inline Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random);
  const double x = normal(random);
  const double y = normal(random);
  return Eigen::Quaterniond(w, x, y, normal(random)).normalized().toRotationMatrix();
}

/// Poses that an arm takes on a random walk in its joints, the first at `start`: on one branch, and
/// of coordinates that it can hold.
inline std::vector<Pose> poses_on_a_walk(const ForwardKinematics& arm, std::mt19937& random,
                                         JointVector q, size_t count, double step) {
  std::normal_distribution<double> normal(0.0, step);
  std::vector<Pose> poses;
  for (size_t k = 0; k < count; ++k) {
    poses.push_back(arm.pose(q));
    for (int i = 0; i < arm.joints(); ++i) {
      q[i] += (arm.type(i) == JointType::kPrismatic ? 0.2 : 1.0) * normal(random);
    }
  }
  return poses;
}

inline std::vector<JointVector> positions_of(const std::vector<Pose>& poses) {
  std::vector<JointVector> positions;
  for (const Pose& pose : poses) positions.emplace_back(pose.translation());
  return positions;
}

/// A spline through the poses with cumulative distances as its parameter, and the orientations too
/// or that of the start.
inline std::unique_ptr<TaskCurve> spline_through(const std::vector<Pose>& poses, int degree,
                                                 bool oriented) {
  std::vector<double> at = {0.0};
  std::vector<Eigen::Matrix3d> rotations = {poses[0].linear()};
  for (size_t k = 1; k < poses.size(); ++k) {
    const double travel = (poses[k].translation() - poses[k - 1].translation()).norm();
    const double turn = rotation_distance(poses[k].linear(), poses[k - 1].linear());
    at.push_back(at.back() + std::hypot(travel, 0.1 * turn));
    rotations.emplace_back(poses[k].linear());
  }
  auto position = std::make_unique<SplineCurve>(
      quintic_chain(natural_spline(positions_of(poses), at, degree), at));
  std::unique_ptr<const OrientationCurve> orientation;
  if (oriented) {
    orientation = std::make_unique<OrientationSpline>(OrientationSpline::through(rotations, at));
  } else {
    orientation = std::make_unique<SteadyTurn>(rotations[0], Eigen::Vector3d::Zero());
  }
  return std::make_unique<ToolCurve>(std::move(position), std::move(orientation));
}

/// A helix or an arc from `from`, turning with it, or at rest, or by `turn` over its length.
inline std::unique_ptr<TaskCurve> helix(const Pose& from, const Eigen::Vector3d& center,
                                        const Eigen::Vector3d& axis, double angle, double pitch,
                                        bool turning) {
  auto position = std::make_unique<HelixCurve>(from.translation(), center, axis, angle, pitch);
  const Eigen::Vector3d rate = turning
                                   ? Eigen::Vector3d(position->axis() * angle / position->length())
                                   : Eigen::Vector3d::Zero();
  auto orientation = std::make_unique<SteadyTurn>(from.linear(), rate);
  return std::make_unique<ToolCurve>(std::move(position), std::move(orientation));
}

/// Joint limits of the size that arms have.
inline JointLimits range_of(const ForwardKinematics& arm) {
  JointVector most(arm.joints());
  for (int i = 0; i < arm.joints(); ++i) {
    most[i] = arm.type(i) == JointType::kPrismatic ? 0.6 : 2.4;
  }
  return symmetric_limits(most);
}

/// A curve of one of five kinds from where the arm stands; small enough that many can be followed.
inline std::unique_ptr<TaskCurve> random_curve(const ForwardKinematics& arm, std::mt19937& random,
                                               const JointVector& start, Hold hold) {
  const Pose from = arm.pose(start);
  const bool oriented = hold == Hold::kAxis || (hold == Hold::kPose && arm.joints() >= 6);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Eigen::Vector3d center = from.translation() + random_vector(random, 0.05);
  const Eigen::Vector3d axis = arm.joints() >= 6 || hold != Hold::kPose ? random_vector(random, 1.0)
                                                                        : Eigen::Vector3d::UnitZ();
  const double angle = (unit(random) < 0.5 ? -1.0 : 1.0) * (0.2 + 6.5 * unit(random));
  switch (random() % 5) {
    case 0:
      return helix(from, center, axis, angle, 0.0, false);
    case 1:
      return helix(from, center, axis, angle, 0.03 * unit(random), hold == Hold::kPose);
    case 2: {
      const auto poses = poses_on_a_walk(arm, random, start, 2 + random() % 6, 0.06);
      return spline_through(poses, 3, oriented);
    }
    case 3: {
      const auto poses = poses_on_a_walk(arm, random, start, 2 + random() % 6, 0.06);
      return spline_through(poses, 5, oriented);
    }
    default: {
      const auto poses = poses_on_a_walk(arm, random, start, 5 + random() % 5, 0.06);
      double length = 0.0;
      for (size_t k = 1; k < poses.size(); ++k) {
        length += (poses[k].translation() - poses[k - 1].translation()).norm();
      }
      return std::make_unique<ToolCurve>(
          std::make_unique<SplineCurve>(b_spline_path(positions_of(poses), 3, length)),
          std::make_unique<SteadyTurn>(from.linear(), Eigen::Vector3d::Zero()));
    }
  }
}

}  // namespace viapoint::testing
