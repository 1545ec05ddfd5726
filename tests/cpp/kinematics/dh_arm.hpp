/// @file
/// Arms of the tests from their standard D-H tables.
#pragma once

#include <string>
#include <vector>

#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/robot_description.hpp"
#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint {

struct DhRow {
  double d, a, alpha;
  JointType type = JointType::kRevolute;
  double theta = 0.0;  ///< constant part of the angle
};

/// Turning joints go ±179°, sliding ones from 0 to 1 m.
inline RobotPtr dh_arm(const std::string& name, const std::vector<DhRow>& rows,
                       const Pose& tool = Pose::Identity()) {
  RobotDescription description;
  description.name = name;
  const auto n = static_cast<Eigen::Index>(rows.size());
  JointLimits& limits = description.limits;
  limits.position_min = JointVector::Constant(n, -179.0 * kDegree);
  limits.position_max = JointVector::Constant(n, 179.0 * kDegree);
  limits.velocity = JointVector::Constant(n, 2.0);
  limits.acceleration = JointVector::Constant(n, 20.0);
  limits.jerk = JointVector::Constant(n, 200.0);
  limits.coupling.resize(0, n);
  Pose link = Pose::Identity();
  for (const DhRow& row : rows) {
    ChainJoint joint;
    joint.type = row.type;
    joint.before = link * Eigen::AngleAxisd(row.theta, Eigen::Vector3d::UnitZ());
    if (row.type == JointType::kPrismatic) {
      const auto i = static_cast<Eigen::Index>(description.chain.size());
      limits.position_min[i] = 0.0;
      limits.position_max[i] = 1.0;
    }
    description.chain.push_back(joint);
    description.joint_names.push_back("joint" + std::to_string(description.chain.size()));
    link = Eigen::Translation3d(row.a, 0.0, row.d) *
           Eigen::AngleAxisd(row.alpha, Eigen::Vector3d::UnitX());
  }
  description.flange = link;
  description.tool = tool;
  return RobotModel::make(description);
}

}  // namespace viapoint
