#include "viapoint/core/joint_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

JointLimits two_joints() {
  JointLimits limits;
  limits.position_min = JointVector::Constant(2, -1.0);
  limits.position_max = JointVector::Constant(2, 1.0);
  limits.velocity = JointVector::Constant(2, 2.0);
  limits.acceleration = JointVector::Constant(2, 3.0);
  limits.jerk = JointVector::Constant(2, 4.0);
  return limits;
}

Problem refusal_of(const JointLimits& limits) {
  try {
    limits.validate();
  } catch (const MotionError& error) {
    return error.problem();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

TEST(JointLimits, AcceptsSoundOnesAndUnlimitedPositions) {
  JointLimits limits = two_joints();
  limits.position_max[1] = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(limits.validate());
}

TEST(JointLimits, RefusesRatesOfZeroNanAndInfinityByJoint) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(bad);
    JointLimits limits = two_joints();
    limits.jerk[1] = bad;
    const Problem problem = refusal_of(limits);
    EXPECT_EQ(problem.code, ErrorCode::kBadLimits);
    EXPECT_EQ(problem.joint, 1);
    EXPECT_NE(problem.message.find("jerk limit of joint 2"), std::string::npos) << problem.message;
  }
}

TEST(JointLimits, RefusesSwappedPositions) {
  JointLimits limits = two_joints();
  limits.position_min[0] = 2.0;
  EXPECT_EQ(refusal_of(limits).joint, 0);
}

TEST(JointLimits, RefusesSizesThatDiffer) {
  JointLimits limits = two_joints();
  limits.acceleration = JointVector::Constant(3, 1.0);
  EXPECT_NE(refusal_of(limits).message.find("acceleration has 3"), std::string::npos);
}

TEST(JointLimits, HoldsCoupledRowsToo) {
  JointLimits limits = two_joints();
  limits.coupling = CouplingMatrix::Ones(1, 2);
  limits.coupling_lower = CouplingVector::Constant(1, -0.5);
  limits.coupling_upper = CouplingVector::Constant(1, 0.5);
  EXPECT_NO_THROW(limits.validate());
  EXPECT_TRUE(limits.contains((JointVector(2) << 0.9, -0.9).finished()));
  EXPECT_FALSE(limits.contains((JointVector(2) << 0.4, 0.4).finished()));
  limits.coupling_upper[0] = -0.5;
  EXPECT_EQ(refusal_of(limits).code, ErrorCode::kBadLimits);
}

TEST(JointLimits, CountNanAsOutside) {
  EXPECT_FALSE(two_joints().contains((JointVector(2) << 0.0, std::nan("")).finished()));
}

}  // namespace
}  // namespace viapoint
