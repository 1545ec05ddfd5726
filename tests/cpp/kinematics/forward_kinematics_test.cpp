#include "viapoint/kinematics/forward_kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

Eigen::Vector3d random_vector(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> component(-1.0, 1.0);
  return {component(generator), component(generator), component(generator)};
}

Pose random_pose(std::mt19937_64& generator) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation_exp(3.0 * random_vector(generator));
  pose.translation() = random_vector(generator);
  return pose;
}

struct RandomChain {
  std::vector<ChainJoint> joints;
  Pose tool;
  JointVector travel;

  explicit RandomChain(std::mt19937_64& generator) {
    const int count = std::uniform_int_distribution<int>(1, 8)(generator);
    travel = JointVector::Zero(count);
    for (int i = 0; i < count; ++i) {
      ChainJoint joint;
      joint.before = random_pose(generator);
      joint.axis = random_vector(generator).normalized();
      if (std::bernoulli_distribution(0.25)(generator)) {
        joint.type = JointType::kPrismatic;
        travel[i] = 0.5;
      }
      joints.push_back(joint);
    }
    tool = random_pose(generator);
  }

  JointVector random_joints(std::mt19937_64& generator) const {
    JointVector q(travel.size());
    for (int i = 0; i < q.size(); ++i) {
      const double range = travel[i] > 0.0 ? travel[i] : 2.0 * kPi;
      q[i] = std::uniform_real_distribution<double>(-range, range)(generator);
    }
    return q;
  }
};

Pose product_of_axis_angles(const RandomChain& chain, const JointVector& q) {
  Pose pose = Pose::Identity();
  for (size_t i = 0; i < chain.joints.size(); ++i) {
    const ChainJoint& joint = chain.joints[i];
    const double value = q[static_cast<Eigen::Index>(i)];
    pose = pose * joint.before;
    if (joint.type == JointType::kPrismatic) {
      pose = pose * Eigen::Translation3d(value * joint.axis);
    } else {
      pose = pose * Eigen::AngleAxisd(value, joint.axis);
    }
  }
  return pose * chain.tool;
}

TEST(ForwardKinematics, EqualsTheProductOfAxisAngleTransforms) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    const RandomChain chain(generator);
    const ForwardKinematics forward(chain.joints, chain.tool);
    const JointVector q = chain.random_joints(generator);
    const Pose expected = product_of_axis_angles(chain, q);
    ASSERT_LT((forward.pose(q).matrix() - expected.matrix()).norm(), 1e-13);
    ASSERT_TRUE(forward.frames(q).pose_base_tool.matrix() == forward.pose(q).matrix());
  }
}

TEST(ForwardKinematics, TakesAnAxisAgainstZ) {
  ChainJoint joint;
  joint.axis = -Eigen::Vector3d::UnitZ();
  Pose tool = Pose::Identity();
  tool.translation() = Eigen::Vector3d(1.0, 0.0, 0.0);
  const ForwardKinematics forward(std::vector<ChainJoint>{joint}, tool);
  const Eigen::Vector3d p = forward.pose(JointVector::Constant(1, kPi / 2.0)).translation();
  EXPECT_LT((p - Eigen::Vector3d(0.0, -1.0, 0.0)).norm(), 1e-15);
}

TEST(ForwardKinematics, JacobianIsTheRateOfThePose) {
  constexpr double kStep = 1e-6;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    const RandomChain chain(generator);
    const ForwardKinematics forward(chain.joints, chain.tool);
    const JointVector q = chain.random_joints(generator);
    const Jacobian jacobian = forward.jacobian(forward.frames(q));
    for (int i = 0; i < forward.joints(); ++i) {
      JointVector step = JointVector::Zero(forward.joints());
      step[i] = kStep;
      const Pose ahead = forward.pose(q + step);
      const Pose behind = forward.pose(q - step);
      const Eigen::Vector3d velocity = (ahead.translation() - behind.translation()) / (2.0 * kStep);
      const Eigen::Vector3d spin =
          rotation_log(ahead.linear() * behind.linear().transpose()) / (2.0 * kStep);
      ASSERT_LT((jacobian.col(i).head<3>() - velocity).norm(), 1e-8);
      ASSERT_LT((jacobian.col(i).tail<3>() - spin).norm(), 1e-8);
    }
  }
}

TEST(ForwardKinematics, JacobianRateIsTheRateOfTheJacobian) {
  constexpr double kStep = 1e-6;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    const RandomChain chain(generator);
    const ForwardKinematics forward(chain.joints, chain.tool);
    const JointVector q = chain.random_joints(generator);
    const JointVector qd = 0.2 * chain.random_joints(generator);
    const JointVector ahead = q + kStep * qd;
    const JointVector behind = q - kStep * qd;
    const Jacobian expected =
        (forward.jacobian(forward.frames(ahead)) - forward.jacobian(forward.frames(behind))) /
        (2.0 * kStep);
    ASSERT_LT((forward.jacobian_rate(forward.frames(q), qd) - expected).norm(), 1e-6);
  }
}

TEST(ForwardKinematics, ReachBoundHoldsForEveryJointAngle) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    const RandomChain chain(generator);
    const ForwardKinematics forward(chain.joints, chain.tool);
    const JointVector bound = forward.reach_bound(chain.travel);
    for (int sample = 0; sample < 200; ++sample) {
      const ChainFrames frames = forward.frames(chain.random_joints(generator));
      for (int i = 0; i < forward.joints(); ++i) {
        const auto k = static_cast<size_t>(i);
        const Eigen::Vector3d arm = frames.pose_base_tool.translation() - frames.origin[k];
        ASSERT_LE(frames.axis[k].cross(arm).norm(), bound[i] + 1e-12) << "joint " << i;
      }
    }
  }
}

TEST(ForwardKinematics, ReachBoundOfAPlanarArmIsItsStretchedLength) {
  ChainJoint shoulder;
  ChainJoint elbow;
  elbow.before.translation() = Eigen::Vector3d(1.0, 0.0, 0.3);  // 0.3 m along the axis: no reach
  Pose tool = Pose::Identity();
  tool.translation() = Eigen::Vector3d(2.0, 0.0, 0.1);
  const ForwardKinematics forward(std::vector<ChainJoint>{shoulder, elbow}, tool);
  const JointVector bound = forward.reach_bound(JointVector::Zero(2));
  EXPECT_NEAR(bound[0], 3.0, 1e-15);
  EXPECT_NEAR(bound[1], 2.0, 1e-15);
}

TEST(ForwardKinematics, RefusesMoreJointsThanItHolds) {
  const std::vector<ChainJoint> joints(kMaxJoints + 1);
  EXPECT_THROW(ForwardKinematics(joints, Pose::Identity()), MotionError);
}

}  // namespace
}  // namespace viapoint
