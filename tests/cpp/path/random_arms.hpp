/// @file
/// Serial chains drawn at random: turning and sliding joints about any axis.
#pragma once

#include <random>
#include <vector>

#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint::testing {

inline ForwardKinematics random_arm(std::mt19937_64& random, int joints) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&](double size) -> Eigen::Vector3d {
    return size * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  };
  const auto random_pose = [&] {
    Pose pose = Pose::Identity();
    pose.translate(vector(0.5));
    pose.rotate(Eigen::AngleAxisd(kPi * uniform(random), vector(1.0).normalized()));
    return pose;
  };
  std::vector<ChainJoint> chain(static_cast<size_t>(joints));
  for (ChainJoint& joint : chain) {
    joint.before = random_pose();
    if (uniform(random) > 0.6) joint.type = JointType::kPrismatic;
  }
  return {chain, random_pose()};
}

}  // namespace viapoint::testing
