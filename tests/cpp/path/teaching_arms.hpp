/// @file
/// Arms of the tests, from their standard D-H tables.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint::testing {

struct DhRow {
  double d, a, alpha;
  JointType type = JointType::kRevolute;
};

inline ForwardKinematics chain_from_dh(const std::vector<DhRow>& rows,
                                       const Pose& tool = Pose::Identity()) {
  std::vector<ChainJoint> joints(rows.size());
  Pose link = Pose::Identity();
  for (size_t i = 0; i < rows.size(); ++i) {
    joints[i].type = rows[i].type;
    joints[i].before = link;
    link = Pose::Identity();
    link.translate(Eigen::Vector3d(rows[i].a, 0.0, rows[i].d));
    link.rotate(Eigen::AngleAxisd(rows[i].alpha, Eigen::Vector3d::UnitX()));
  }
  return {joints, link * tool};
}

/// Textbook §3.
inline ForwardKinematics puma560() {
  return chain_from_dh({{0, 0, -kPi / 2},
                        {0, 0.432, 0},
                        {0.149, -0.02, kPi / 2},
                        {0.433, 0, -kPi / 2},
                        {0, 0, kPi / 2},
                        {0, 0, 0}});
}

/// Standard D-H table of the maker.
inline ForwardKinematics ur5e() {
  return chain_from_dh({{0.1625, 0, kPi / 2},
                        {0, -0.425, 0},
                        {0, -0.3922, 0},
                        {0.1333, 0, kPi / 2},
                        {0.0997, 0, -kPi / 2},
                        {0.0996, 0, 0}});
}

/// Textbook §5: p = (−d3 sin θ1, d3 cos θ1, 0.5 + d2).
inline ForwardKinematics rpp() {
  return chain_from_dh(
      {{0.5, 0, 0}, {0, 0, -kPi / 2, JointType::kPrismatic}, {0, 0, 0, JointType::kPrismatic}});
}

/// Textbook §5: four axes, the tool points down.
inline ForwardKinematics scara() {
  return chain_from_dh(
      {{0.4, 0.3, 0}, {0, 0.25, kPi}, {0, 0, 0, JointType::kPrismatic}, {0.05, 0, 0}});
}

/// Textbook §5: a1 = 1, a2 = 2, in the plane.
inline ForwardKinematics two_link() { return chain_from_dh({{0, 1, 0}, {0, 2, 0}}); }

/// Seven joints: a redundant arm.
inline ForwardKinematics seven_joints() {
  return chain_from_dh({{0.34, 0, -kPi / 2},
                        {0, 0, kPi / 2},
                        {0.4, 0, kPi / 2},
                        {0, 0, -kPi / 2},
                        {0.4, 0, -kPi / 2},
                        {0, 0, kPi / 2},
                        {0.126, 0, 0}});
}

/// The panda's chain: seven joints with offsets at elbow and wrist.
inline ForwardKinematics panda() {
  return chain_from_dh({{0.333, 0, -kPi / 2},
                        {0, 0, kPi / 2},
                        {0.316, 0.0825, kPi / 2},
                        {0, -0.0825, -kPi / 2},
                        {0.384, 0, kPi / 2},
                        {0, 0.088, kPi / 2},
                        {0.107, 0, 0}});
}

/// A tool that points aside: its spin is no joint's turn.
inline ForwardKinematics torch() {
  Pose tool = Pose::Identity();
  tool.translate(Eigen::Vector3d(0.05, 0.02, 0.15));
  tool.rotate(Eigen::AngleAxisd(40.0 * kDegree, Eigen::Vector3d::UnitY()));
  return chain_from_dh({{0, 0, -kPi / 2},
                        {0, 0.432, 0},
                        {0.149, -0.02, kPi / 2},
                        {0.433, 0, -kPi / 2},
                        {0, 0, kPi / 2},
                        {0, 0, 0}},
                       tool);
}

/// Too few joints for a pose, enough for a position and an axis.
inline ForwardKinematics five_joints() {
  return chain_from_dh({{0, 0, -kPi / 2},
                        {0, 0.432, 0},
                        {0.149, -0.02, kPi / 2},
                        {0.433, 0, -kPi / 2},
                        {0.1, 0, kPi / 2}});
}

inline JointVector joints_in_degrees(std::initializer_list<double> degrees) {
  JointVector q(static_cast<int>(degrees.size()));
  int i = 0;
  for (const double value : degrees) q[i++] = value * kDegree;
  return q;
}

inline JointLimits symmetric_limits(const JointVector& position) {
  const auto joints = static_cast<int>(position.size());
  JointLimits limits;
  limits.position_max = position;
  limits.position_min = -position;
  limits.velocity = JointVector::Constant(joints, 3.0);
  limits.acceleration = JointVector::Constant(joints, 30.0);
  limits.jerk = JointVector::Constant(joints, 300.0);
  limits.coupling.resize(0, joints);
  limits.coupling_lower.resize(0);
  limits.coupling_upper.resize(0);
  return limits;
}

inline JointLimits puma560_limits() {
  return symmetric_limits(joints_in_degrees({160, 125, 135, 140, 100, 260}));
}

inline JointLimits no_position_limits(int joints) {
  return symmetric_limits(JointVector::Constant(joints, std::numeric_limits<double>::infinity()));
}

inline JointVector random_joints(std::mt19937& random, const JointLimits& limits) {
  JointVector q(limits.joints());
  for (int i = 0; i < q.size(); ++i) {
    q[i] = std::uniform_real_distribution<double>(limits.position_min[i],
                                                  limits.position_max[i])(random);
  }
  return q;
}

}  // namespace viapoint::testing
