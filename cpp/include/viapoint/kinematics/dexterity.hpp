/// @file
/// How well an arm moves at one place: its Jacobian J = U Σ Vᵀ, where joint rates of length 1
/// become tool rates in an ellipsoid with the axes σ_i u_i (Yoshikawa 1985). Turning and sliding
/// joints are weighed alike, 1 rad/s as 1 m/s.
#pragma once

#include <Eigen/Core>

#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint {

/// The ellipsoid of one kind of motion, longest axis first. An arm that cannot move along some
/// direction has a length 0 there.
struct VelocityEllipsoid {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< unit vectors in the base frame, columns
  Eigen::Vector3d lengths = Eigen::Vector3d::Zero();   ///< [m or rad, per unit joint rate]
};

struct Dexterity {
  /// √det(J Jᵀ) over the rows the arm can move, as RobotModel::manipulability().
  double yoshikawa = 0.0;
  /// Least over greatest principal acceleration of the tool's point, in [0, 1], for drives that
  /// give each joint its acceleration limit: the ratio of the singular values of the position rows
  /// of J diag(a). Asada's measure (1983), with the drives' limits in the place of inertias, which
  /// a description does not have.
  double asada = 0.0;
  /// Least over greatest singular value of those rows, metres divided by `length`, in [0, 1]: 1 is
  /// equal in all directions, 0 singular (Salisbury & Craig 1982). Its inverse is the condition
  /// number.
  double isotropy = 0.0;
  double condition = 0.0;  ///< greatest over least singular value; infinite at a singular pose
  double least = 0.0;      ///< least singular value of those rows
  double length = 1.0;     ///< the arm's reach, by which metres become comparable with radians [m]
  VelocityEllipsoid linear;   ///< of the tool's point
  VelocityEllipsoid angular;  ///< of its orientation
};

/// Real-time: not. Threads: any. @throws MotionError(kUncontrolled, kBadArgument)
[[nodiscard]] Dexterity dexterity(const RobotModel& robot, const JointVector& q);

}  // namespace viapoint
