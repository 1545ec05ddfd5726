#include <gtest/gtest.h>

#include <cmath>

#include "problem_count.hpp"
#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

const JointLimits kLimits = even_limits(1, 2.0, 20.0, 200.0);

Problem refusal(const std::vector<TrajectoryPiece>& pieces, const JointLimits& limits,
                const JointVector& position) {
  // Built under loose limits: what counts is what admit() proves anew.
  const Trajectory trajectory(pieces, even_limits(1, 1e3, 1e6, 1e12));
  try {
    admit(trajectory, limits, position);
  } catch (const MotionError& error) {
    return error.problem();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

std::vector<TrajectoryPiece> move() {
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(1), JointVector::Constant(1, 1.0), kLimits, 4);
  return pieces;
}

TEST(Admission, AcceptsAMotionThatUsesItsLimitsUp) {
  EXPECT_NO_THROW(admit(Trajectory(move(), kLimits), kLimits, JointVector::Zero(1)));
  EXPECT_NO_THROW(admit(Trajectory(move(), kLimits), kLimits, JointVector::Constant(1, 0.9e-6)));
}

TEST(Admission, RefusesAnArmThatRestsElsewhere) {
  const Problem problem = refusal(move(), kLimits, JointVector::Constant(1, 1.1e-6));
  EXPECT_EQ(problem.code, ErrorCode::kNotAtStart);
  EXPECT_EQ(problem.joint, 0);
  EXPECT_FALSE(problem.ways_out.empty());
}

TEST(Admission, RefusesEachLimitByName) {
  const JointVector zero = JointVector::Zero(1);
  EXPECT_EQ(refusal(move(), even_limits(1, 1.9, 20.0, 200.0), zero).code,
            ErrorCode::kVelocityLimit);
  EXPECT_EQ(refusal(move(), even_limits(1, 2.0, 19.0, 200.0), zero).code,
            ErrorCode::kAccelerationLimit);
  const Problem jerk = refusal(move(), even_limits(1, 2.0, 20.0, 190.0), zero);
  EXPECT_EQ(jerk.code, ErrorCode::kJerkLimit);
  EXPECT_EQ(jerk.move, 4);
  JointLimits narrow = kLimits;
  narrow.position_max[0] = 0.99;
  EXPECT_EQ(refusal(move(), narrow, zero).code, ErrorCode::kJointLimit);
}

TEST(Admission, RefusesAViolationPlantedBetweenTwoSamplesAMicrosecondApart) {
  std::vector<TrajectoryPiece> pieces;
  append_wait(pieces, JointVector::Zero(1), 1.0001e-3, 0);
  // A bump of 0.8 µs between two whole microseconds: out and back, at rest to second order at the
  // ends of both parts.
  TrajectoryPiece bump;
  bump.duration = 0.4e-6;
  bump.joints = 1;
  bump.move = 2;
  bump.path[1][0] = 1e-12;
  bump.timing = {0.0, 0.0, 0.0, 10.0, -15.0, 6.0};
  TrajectoryPiece back = bump;
  back.path[0][0] = 1e-12;
  back.path[1][0] = -1e-12;
  pieces.push_back(bump);
  pieces.push_back(back);
  append_wait(pieces, JointVector::Zero(1), 1e-3, 3);
  const Trajectory trajectory(pieces, kLimits);
  for (int k = 0; k < problems(2000); ++k) {
    ASSERT_LE(std::abs(trajectory.at(k * 1e-6).qddd[0]), kLimits.jerk[0]) << k;
  }
  const Problem problem = refusal(pieces, kLimits, JointVector::Zero(1));
  EXPECT_EQ(problem.code, ErrorCode::kJerkLimit);
  EXPECT_EQ(problem.move, 2);
}

TEST(Admission, RefusesAMotionThatStartsAtSpeed) {
  std::vector<TrajectoryPiece> pieces = move();
  pieces.erase(pieces.begin());
  const Trajectory trajectory(pieces, kLimits);
  try {
    admit(trajectory, kLimits, trajectory.at(0.0).q);
    FAIL();
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kNotAtRest);
  }
}

TEST(Admission, RefusesOtherNumbersOfJoints) {
  EXPECT_EQ(refusal(move(), even_limits(2, 2.0, 20.0, 200.0), JointVector::Zero(2)).code,
            ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace viapoint
