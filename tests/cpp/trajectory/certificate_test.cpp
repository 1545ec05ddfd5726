#include "viapoint/trajectory/certificate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "trajectory/trajectory_fixtures.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {
namespace {

using testing::one_joint_piece;
using testing::smooth_move;
using testing::uniform_limits;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

JointLimits generous(int joints = 1) { return uniform_limits(joints, 100.0, 1e3, 1e4, 1e6); }

Certificate certify_one(const TrajectoryPiece& piece, const JointLimits& limits) {
  return certify(std::span(&piece, 1), limits);
}

/// The problems with a code, in their order.
std::vector<Problem> of_code(const Certificate& certificate, ErrorCode code) {
  std::vector<Problem> found;
  std::ranges::copy_if(certificate.problems, std::back_inserter(found),
                       [&](const Problem& problem) { return problem.code == code; });
  return found;
}

// The smooth step's extrema in closed form: 15/8 Δ/T, 10/√3 Δ/T², 60 Δ/T³.
TEST(Certificate, FindsTheExtremaOfTheSmoothStep) {
  constexpr double kDistance = 2.0, kTime = 0.7;
  TrajectoryPiece piece = smooth_move(0.5, 0.5 - kDistance, kTime);
  piece.move = 7;
  const Certificate certificate = certify_one(piece, generous());
  EXPECT_TRUE(certificate.holds());
  const double velocity = 1.875 * kDistance / kTime;
  const double acceleration = 10.0 / std::sqrt(3.0) * kDistance / (kTime * kTime);
  const double jerk = 60.0 * kDistance / (kTime * kTime * kTime);
  EXPECT_NEAR(certificate.velocity[0].value, velocity, 1e-9 * 1e3);
  EXPECT_NEAR(certificate.velocity[0].time, 0.5 * kTime, 1e-4);
  EXPECT_NEAR(certificate.velocity[0].share, velocity / 1e3, 1e-9);
  EXPECT_NEAR(certificate.acceleration[0].share, acceleration / 1e4, 1e-9);
  EXPECT_NEAR(certificate.jerk[0].share, jerk / 1e6, 1e-9);
  EXPECT_EQ(certificate.jerk[0].move, 7);
  EXPECT_GE(certificate.acceleration[0].value, acceleration * (1 - 1e-15));
  EXPECT_NEAR(certificate.position_min[0], 0.5 - kDistance, 1e-9);
  EXPECT_NEAR(certificate.position_max[0], 0.5, 1e-9);
}

TEST(Certificate, HoldsWithEveryLimitUsedToTheLast) {
  const TrajectoryPiece piece = smooth_move(0.0, 1.0, 1.0);
  const JointLimits exact = uniform_limits(1, 1.0, 1.875, 10.0 / std::sqrt(3.0), 60.0);
  const Certificate certificate = certify_one(piece, exact);
  EXPECT_TRUE(certificate.holds()) << certificate.problems.front().describe();
  for (const auto* extrema :
       {&certificate.velocity, &certificate.acceleration, &certificate.jerk}) {
    EXPECT_NEAR(extrema->front().share, 1.0, 1e-9);
  }
}

struct Tightened {
  ErrorCode code;
  JointVector JointLimits::* limit;
  double time;
};

TEST(Certificate, NamesJointPlaceValueAndLimitOfWhatIsBroken) {
  for (const Tightened& tightened :
       {Tightened{ErrorCode::kVelocityLimit, &JointLimits::velocity, 1.5},
        Tightened{ErrorCode::kAccelerationLimit, &JointLimits::acceleration, 1.21132486540519},
        Tightened{ErrorCode::kJerkLimit, &JointLimits::jerk, 1.0}}) {
    SCOPED_TRACE(to_string(tightened.code));
    // Joint 2 moves in the second piece only.
    std::vector<TrajectoryPiece> pieces(2);
    for (TrajectoryPiece& piece : pieces) {
      piece = smooth_move(0.0, 0.0, 1.0);
      piece.joints = 2;
    }
    pieces[1].path[1][1] = 1.0;
    pieces[1].move = 3;
    JointLimits limits = uniform_limits(2, 1.0, 1.875, 10.0 / std::sqrt(3.0), 60.0);
    (limits.*tightened.limit) *= 1.0 - 3e-6;
    const double limit = (limits.*tightened.limit)[1];

    const Certificate certificate = certify(pieces, limits);
    ASSERT_EQ(certificate.problems.size(), 1U);
    const Problem& problem = certificate.problems.front();
    EXPECT_EQ(problem.code, tightened.code);
    EXPECT_EQ(problem.joint, 1);
    EXPECT_EQ(problem.move, 3);
    EXPECT_NEAR(*problem.time, tightened.time, 1e-4);
    EXPECT_NEAR(*problem.value, limit / (1.0 - 3e-6), 1e-8 * limit);
    EXPECT_EQ(problem.limit, limit);
    EXPECT_NE(problem.message.find("joint 2"), std::string::npos) << problem.message;
    EXPECT_FALSE(problem.ways_out.empty());
  }
}

TEST(Certificate, FindsPositionsBetweenTheEnds) {
  // There and back within one piece: u rises to 1 and falls again.
  const TrajectoryPiece piece =
      one_joint_piece(1.0, {0.0, 1.0, 0, 0, 0, 0}, testing::monomials_of({0, 0, 0, 2.0, 0, 0}));
  const double top = 2.0 * 10 * 0.216 * 0.16;  // B_3 of degree 5 has its top at 3/5
  JointLimits limits = generous();
  limits.position_max[0] = top + 1e-8;
  EXPECT_TRUE(of_code(certify_one(piece, limits), ErrorCode::kJointLimit).empty());
  limits.position_max[0] = top - 1e-8;
  const auto problems = of_code(certify_one(piece, limits), ErrorCode::kJointLimit);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NEAR(*problems[0].time, 0.6, 1e-4);
  EXPECT_NEAR(*problems[0].value, top, 1e-9);
}

TEST(Certificate, HoldsBothSidesOfThePositionLimits) {
  JointLimits limits = generous();
  limits.position_min[0] = -1.0;
  limits.position_max[0] = 1.0;
  const auto down = of_code(certify_one(smooth_move(0, -1.5, 1.0), limits), ErrorCode::kJointLimit);
  ASSERT_EQ(down.size(), 1U);
  EXPECT_EQ(down[0].limit, -1.0);
  EXPECT_NEAR(*down[0].value, -1.5, 1e-9);
  const auto up = of_code(certify_one(smooth_move(0, 1.5, 1.0), limits), ErrorCode::kJointLimit);
  ASSERT_EQ(up.size(), 1U);
  EXPECT_EQ(up[0].limit, 1.0);
  EXPECT_TRUE(certify_one(smooth_move(-1.0, 1.0, 1.0), limits).holds());
}

TEST(Certificate, BoundsCoupledLimitsWhereNoJointIsAtItsOwn) {
  // Joint 1 goes up and comes back while joint 2 goes on: their sum is largest in between.
  TrajectoryPiece piece = one_joint_piece(1.0, {0, 0, 0, 10, -15, 6});
  piece.joints = 2;
  piece.path = {};
  piece.path[1] = {4.0, 1.0};
  piece.path[2] = {-4.0, 0.0};
  JointLimits limits = generous(2);
  limits.coupling.resize(1, 2);
  limits.coupling << 1.0, 1.0;
  limits.coupling_lower = CouplingVector::Constant(1, -0.1);
  // 5u - 4u² is largest at u = 5/8.
  const double top = 25.0 / 16.0;
  limits.coupling_upper = CouplingVector::Constant(1, top + 1e-8);
  EXPECT_TRUE(of_code(certify_one(piece, limits), ErrorCode::kCouplingLimit).empty());
  limits.coupling_upper[0] = top - 1e-8;
  const auto problems = of_code(certify_one(piece, limits), ErrorCode::kCouplingLimit);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NEAR(*problems[0].time, 0.625, 1e-4);
  EXPECT_NEAR(*problems[0].value, top, 1e-9);
  limits.coupling_upper[0] = 2.0;
  limits.coupling_lower[0] = 0.1;
  const auto low = of_code(certify_one(piece, limits), ErrorCode::kCouplingLimit);
  ASSERT_EQ(low.size(), 1U);
  EXPECT_NEAR(*low[0].value, 0.0, 1e-9);
}

TEST(Certificate, RefusesMotionThatIsNotAtRestAtItsEnds) {
  const TrajectoryPiece cruise = one_joint_piece(2.0, {0, 1, 0, 0, 0, 0});
  const Certificate certificate = certify_one(cruise, generous());
  EXPECT_EQ(certificate.start_speed, 0.5);
  EXPECT_EQ(certificate.end_speed, 0.5);
  const auto problems = of_code(certificate, ErrorCode::kNotAtRest);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].time, 0.0);
  EXPECT_EQ(problems[1].time, 2.0);

  // u = 3x² - 2x³: no speed at the ends, but acceleration.
  const TrajectoryPiece cubic = one_joint_piece(1.0, {0, 1, 0, 0, 0, 0}, {0, 0, 3, -2, 0, 0});
  const Certificate jerky = certify_one(cubic, generous());
  EXPECT_EQ(jerky.start_acceleration, 6.0);
  EXPECT_EQ(jerky.end_acceleration, 6.0);
  EXPECT_EQ(of_code(jerky, ErrorCode::kNotAtRest).size(), 2U);
}

TEST(Certificate, RefusesPiecesThatDoNotMeet) {
  constexpr double kStep = 1e-8;
  const Certificate position =
      certify(std::vector{smooth_move(0, 1, 1.0), smooth_move(1 + kStep, 0, 1.0)}, generous());
  EXPECT_NEAR(position.position_jump, kStep, 1e-15);
  ASSERT_EQ(position.problems.size(), 1U);
  EXPECT_EQ(position.problems[0].code, ErrorCode::kDiscontinuous);
  EXPECT_EQ(position.problems[0].time, 1.0);

  // Half way of a smooth step is the fastest: a stop there is a step of the velocity.
  TrajectoryPiece half = smooth_move(0, 1, 1.0);
  half.timing = testing::monomials_of({0, 0, 0, 0.25, 0.5});
  const double speed = half.at(1.0).qd[0];
  const Certificate velocity = certify(std::vector{half, smooth_move(0.5, 0, 1.0)}, generous());
  EXPECT_NEAR(velocity.velocity_jump, speed, 1e-12);
  EXPECT_EQ(velocity.problems.front().code, ErrorCode::kDiscontinuous);

  const TrajectoryPiece cubic = one_joint_piece(1.0, {0, 1, 0, 0, 0, 0}, {0, 0, 0, 4, -3, 0});
  const Certificate acceleration = certify(std::vector{cubic, smooth_move(1, 0, 1.0)}, generous());
  EXPECT_NEAR(acceleration.acceleration_jump, 12.0, 1e-12);
  EXPECT_EQ(of_code(acceleration, ErrorCode::kDiscontinuous).size(), 1U);
}

TEST(Certificate, TakesAStepForRoundingByTheSizeOfThePositions) {
  constexpr double kFar = 1e8;
  JointLimits limits = generous();
  limits.position_max.setConstant(1e9);
  const auto certified = [&](double step) {
    return certify(
        std::vector{smooth_move(kFar, kFar + 1, 1.0), smooth_move(kFar + 1 + step, kFar, 1.0)},
        limits);
  };
  EXPECT_TRUE(certified(1e-7).holds());
  const Certificate certificate = certified(1e-6);
  ASSERT_EQ(certificate.problems.size(), 1U);
  EXPECT_EQ(certificate.problems[0].code, ErrorCode::kDiscontinuous);
}

TEST(Certificate, RefusesATimingThatLeavesItsPath) {
  for (const auto& timing : {std::array<double, 6>{0, 0, 0, 10.0, -15.0, 6.0 + 1e-6},
                             std::array<double, 6>{-1e-6, 0, 0, 10.0, -15.0, 6.0},
                             std::array<double, 6>{0, 5.0, -4.0, 0, 0, 0}}) {
    const auto problems =
        of_code(certify_one(one_joint_piece(1.0, {0, 1, 0, 0, 0, 0}, timing), generous()),
                ErrorCode::kBadArgument);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_NE(problems[0].message.find("[0, 1]"), std::string::npos) << problems[0].message;
  }
}

TEST(Certificate, RefusesPiecesThatAreNone) {
  const auto spoilt = [](auto spoil) {
    std::vector<TrajectoryPiece> pieces(3, smooth_move(0, 0, 1.0));
    spoil(pieces[1]);
    return certify(pieces, generous());
  };
  for (const Certificate& certificate :
       {spoilt([](auto& p) { p.path[3][0] = kNan; }), spoilt([](auto& p) { p.timing[0] = kNan; }),
        spoilt([](auto& p) { p.path[0][0] = kInfinity; }), spoilt([](auto& p) { p.duration = 0; }),
        spoilt([](auto& p) { p.duration = kNan; }), spoilt([](auto& p) { p.joints = 2; })}) {
    EXPECT_FALSE(certificate.holds());
    ASSERT_EQ(of_code(certificate, ErrorCode::kBadArgument).size(), 1U);
    EXPECT_NE(certificate.problems[0].message.find("piece 1"), std::string::npos);
    EXPECT_EQ(certificate.problems[0].time, 1.0);
  }
  EXPECT_THROW((void)certify({}, generous()), MotionError);
}

TEST(Certificate, TakesOverflowForABrokenLimit) {
  const Certificate certificate =
      certify_one(one_joint_piece(1e-20, {0, 1e280, 0, 0, 0, 0}, testing::kSmoothStep), generous());
  EXPECT_FALSE(certificate.holds());
  EXPECT_EQ(of_code(certificate, ErrorCode::kJerkLimit).size(), 1U);
}

TEST(Certificate, TakesACoefficientThatOverflowsToNanForABrokenLimit) {
  // ∞ - ∞ in the middle of the composition, all input finite.
  const Certificate certificate = certify_one(
      one_joint_piece(1.0, {0, 1.5e308, -1.5e308, 0, 0, 0}, {0, 0.5, 0.5, 0, 0, 0}), generous());
  EXPECT_FALSE(of_code(certificate, ErrorCode::kJerkLimit).empty());
}

TEST(Certificate, PutsTheWorstFirst) {
  std::vector<TrajectoryPiece> pieces(1, smooth_move(0, 0, 1.0));
  pieces[0].joints = 3;
  pieces[0].path[1] = {1.0, 3.0, 2.0};
  const JointLimits limits = uniform_limits(3, 100.0, 0.1, 1e4, 1e6);
  const Certificate certificate = certify(pieces, limits);
  ASSERT_EQ(certificate.problems.size(), 3U);
  EXPECT_EQ(certificate.problems[0].joint, 1);
  EXPECT_EQ(certificate.problems[1].joint, 2);
  EXPECT_EQ(certificate.problems[2].joint, 0);
}

TEST(Certificate, ReportsOneProblemAJointAndQuantity) {
  std::vector<TrajectoryPiece> pieces;
  for (int i = 0; i < 20; ++i) {
    pieces.push_back(smooth_move(i, i + 1.0 + 0.01 * (i == 13), 1.0));
    pieces.back().path[0][0] = i;
    pieces.back().move = i;
  }
  const Certificate certificate = certify(pieces, uniform_limits(1, 100.0, 1.0, 1e4, 1e6));
  const auto velocity = of_code(certificate, ErrorCode::kVelocityLimit);
  ASSERT_EQ(velocity.size(), 1U);
  EXPECT_EQ(velocity[0].move, 13);
}

}  // namespace
}  // namespace viapoint
