/// @file
/// A joint as the base sees it at q = 0, the path on which it carries a point, and equations in one
/// joint. What the closed forms of decomposed arms are made of: each step is one of the canonical
/// subproblems (Paden 1986; Kahan 1983; Elias & Wen 2022).
#pragma once

#include <array>

#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// A joint at q = 0.
struct Screw {
  JointType type = JointType::kRevolute;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   ///< unit vector
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< a point on the axis [m]

  /// The joint's own displacement by q.
  [[nodiscard]] Pose motion(double q) const;
  [[nodiscard]] Eigen::Matrix3d rotation(double q) const;
};

/// Where a joint carries a point: fixed + first cos q + second sin q, or, sliding, fixed + first q.
struct Track {
  JointType type = JointType::kPrismatic;
  Eigen::Vector3d fixed = Eigen::Vector3d::Zero();
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d second = Eigen::Vector3d::Zero();

  /// A point that no joint moves.
  [[nodiscard]] static Track still(const Eigen::Vector3d& point);
  [[nodiscard]] static Track of(const Screw& joint, const Eigen::Vector3d& point);
  /// Of the joint's inverse: where it takes the point from.
  [[nodiscard]] static Track back(const Screw& joint, const Eigen::Vector3d& point);
  [[nodiscard]] Eigen::Vector3d at(double q) const;
};

/// Roots of an equation in one joint. Two are the two sides of a choice: the first is +, the second
/// -, and they meet where `apart` is 0.
struct Roots {
  int count = 0;
  std::array<double, 2> q{};
  double apart = 0.0;    ///< from where the roots meet [rad or m]
  double missing = 0.0;  ///< without a root: by how much the value is out of range [its unit]
  bool free = false;     ///< every q will do
};

/// A function of one joint: constant + first cos q + second sin q, or, sliding, constant + first q
/// + second q².
struct JointTerm {
  JointType type = JointType::kPrismatic;
  double constant = 0.0;
  double first = 0.0;
  double second = 0.0;

  /// direction · x over the track.
  [[nodiscard]] static JointTerm height(const Track& track, const Eigen::Vector3d& direction);
  /// |x − centre|² over the track.
  [[nodiscard]] static JointTerm square(const Track& track, const Eigen::Vector3d& centre);
  [[nodiscard]] double at(double q) const;
  /// Largest coefficient of what depends on q.
  [[nodiscard]] double weight() const;
  /// Every q in (-π, π], or every travel, with at(q) = value.
  /// @param slack how far out of range a value may be to be taken for the end of the range
  /// @param least a weight below which q is free
  [[nodiscard]] Roots solve(double value, double slack, double least) const;
};

/// The angle about `axis` that turns the direction of `from` into that of `to`, both seen along it
/// [rad].
[[nodiscard]] double angle_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& from,
                                 const Eigen::Vector3d& to);

}  // namespace viapoint
