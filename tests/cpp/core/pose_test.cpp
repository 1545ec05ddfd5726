#include "viapoint/core/pose.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

Eigen::Matrix4d pose_a() {
  Eigen::Matrix4d m;
  m << 0.64, 0.77, 0, 0.05, 0.77, -0.64, 0, -0.55, 0, 0, -1, -0.6, 0, 0, 0, 1;
  return m;
}

Eigen::Matrix4d pose_c_as_printed() {
  Eigen::Matrix4d m;
  m << 0.41, 0.29, 0.87, 0.6, 0.69, 0.71, -0.09, 0.15, -0.6, 0.64, 0.49, -0.3, 0, 0, 0, 1;
  return m;
}

ErrorCode code_of(const Eigen::Matrix4d& matrix) {
  try {
    (void)checked_pose(matrix);
  } catch (const MotionError& error) {
    return error.code();
  }
  ADD_FAILURE() << "accepted:\n" << matrix;
  return ErrorCode::kInternal;
}

Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

TEST(CheckedPose, ProjectsAPoseRoundedToTwoDecimals) {
  const CheckedPose checked = checked_pose(pose_a());
  EXPECT_TRUE(checked.pose.linear().isUnitary(1e-14));
  EXPECT_NEAR(checked.pose.linear().determinant(), 1.0, 1e-14);
  EXPECT_GT(checked.correction, 1e-4);
  EXPECT_LT(checked.correction, 0.005);
  EXPECT_EQ(checked.pose.translation(), Eigen::Vector3d(0.05, -0.55, -0.6));
}

TEST(CheckedPose, RefusesTextbookPoseCWithItsWorstColumns) {
  try {
    (void)checked_pose(pose_c_as_printed());
    FAIL() << "pose C as printed is no rotation";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kNotARotation);
    EXPECT_NE(error.problem().message.find("columns 2 and 3 are 59.9°"), std::string::npos)
        << error.what();
    EXPECT_FALSE(error.problem().ways_out.empty());
  }
}

TEST(CheckedPose, AcceptsPoseCWithItsSignPutBack) {
  Eigen::Matrix4d c = pose_c_as_printed();
  c(0, 1) = -0.29;
  EXPECT_LT(checked_pose(c).correction, 0.01);
}

TEST(CheckedPose, RefusesReflectionsAndBadRowsByName) {
  Eigen::Matrix4d reflection = Eigen::Matrix4d::Identity();
  reflection(0, 0) = -1.0;
  EXPECT_EQ(code_of(reflection), ErrorCode::kNotARotation);

  Eigen::Matrix4d transposed = pose_a().transpose();
  EXPECT_EQ(code_of(transposed), ErrorCode::kBadArgument);

  Eigen::Matrix4d nan = Eigen::Matrix4d::Identity();
  nan(1, 1) = std::nan("");
  EXPECT_EQ(code_of(nan), ErrorCode::kBadArgument);

  EXPECT_EQ(
      code_of(Eigen::Matrix4d::Zero() + Eigen::Vector4d(0, 0, 0, 1).asDiagonal().toDenseMatrix()),
      ErrorCode::kNotARotation);
}

TEST(CheckedPose, LeavesRotationsUntouchedToTheLastBit) {
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = random_rotation(random);
    const CheckedPose checked = checked_pose(matrix);
    ASSERT_EQ(checked.pose.matrix(), matrix);
    ASSERT_EQ(checked.correction, 0.0);
  }
}

TEST(RotationLog, IsTheInverseOfExpUpToPi) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-14.0, 0.0);
  for (int i = 0; i < 5000; ++i) {
    SCOPED_TRACE(i);
    const Eigen::Vector3d axis =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    // Angles over all decades, from both ends: tiny, and π less a tiny amount.
    const double small = std::pow(10.0, exponent(random));
    const double angle = i % 2 == 0 ? small : kPi - small;
    const Eigen::Vector3d back = rotation_log(rotation_exp(angle * axis));
    ASSERT_NEAR(back.norm(), angle, 1e-12);
    const Eigen::Matrix3d again = rotation_exp(back);
    ASSERT_LT((again - rotation_exp(angle * axis)).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(RotationDistance, OfAHalfTurnIsPi) {
  const Eigen::Matrix3d half = Eigen::Vector3d(1, -1, -1).asDiagonal();
  EXPECT_DOUBLE_EQ(rotation_distance(Eigen::Matrix3d::Identity(), half), kPi);
}

}  // namespace
}  // namespace viapoint
