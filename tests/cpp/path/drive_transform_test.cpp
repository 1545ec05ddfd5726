#include "viapoint/path/drive_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "golden.hpp"
#include "problem_count.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

DriveMotion reference_motion() {
  const nlohmann::json poses = golden("puma560").at("fk_of_joints");
  const std::array points{golden_pose(poses.at("A")), golden_pose(poses.at("B")),
                          golden_pose(poses.at("C"))};
  return DriveMotion(points, std::array{0.5, 0.5}, 0.2);
}

Pose random_pose(std::mt19937_64& random) {
  std::normal_distribution<double> any;
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(any(random), any(random), any(random));
  pose.linear() = Eigen::Quaterniond(any(random), any(random), any(random), any(random))
                      .normalized()
                      .toRotationMatrix();
  return pose;
}

TEST(DriveMotion, GoldenTextbookSection3CartesianMove) {
  const DriveMotion motion = reference_motion();
  ASSERT_EQ(motion.parts(), 3u);
  EXPECT_EQ(motion.duration(), 1.0);
  const nlohmann::json rows = golden("puma560").at("cartesian_move");
  ASSERT_EQ(rows.size(), 9u);
  for (const auto& row : rows) {
    const double t = row.at("t").get<double>() + 0.5;
    EXPECT_LT(
        (motion.at(t).pose.matrix() - golden_pose(row.at("pose")).matrix()).cwiseAbs().maxCoeff(),
        1e-12)
        << "t = " << t;
  }
}

TEST(DriveMotion, GoldenTextbookSection3AngularVelocityJumpsWhereTheTransitionBegins) {
  const DriveMotion motion = reference_motion();
  const double t = motion.end_of(0);
  const ToolState before = motion.at(0, t), after = motion.at(1, t);
  const auto in_tool = [](const ToolState& state) {
    return (state.pose.linear().transpose() * state.angular_velocity).eval();
  };
  EXPECT_LT((in_tool(before) - Eigen::Vector3d(-4.57, -2.10, -1.69)).cwiseAbs().maxCoeff(), 0.005);
  EXPECT_LT((in_tool(after) - Eigen::Vector3d(-5.38, -0.34, -2.76)).cwiseAbs().maxCoeff(), 0.005);
  EXPECT_NEAR((in_tool(after) - in_tool(before)).norm(), 2.2, 0.05);
  EXPECT_LT((before.velocity - after.velocity).norm(), 1e-12);
  EXPECT_LT((before.pose.matrix() - after.pose.matrix()).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(DriveTransform, LeadsFromOnePoseToTheOther) {
  for (int seed = 0; seed < problems(5000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const Pose from = random_pose(random), to = random_pose(random);
    const DriveTransform drive = DriveTransform::between(from, to);
    EXPECT_LT(((from * drive.pose()).matrix() - to.matrix()).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_GE(drive.theta, 0.0);
    EXPECT_LE(drive.theta, kPi);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(DriveTransform, IsDefinedWhereTheApproachAxisDoesNotTurn) {
  for (const double tilt : {0.0, 1e-300, 1e-14, 1e-9, kPi, kPi - 1e-9}) {
    SCOPED_TRACE(tilt);
    const Pose from = Pose::Identity();
    Pose to = Pose::Identity();
    to.linear() = (Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix();
    const DriveTransform drive = DriveTransform::between(from, to);
    EXPECT_LT((drive.pose().linear() - to.linear()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(DriveMotion, MeetsItselfInPoseAndVelocityThroughAnyNumberOfPoses) {
  for (int seed = 0; seed < problems(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> seconds(0.4, 2.0);
    std::vector<Pose> poses{random_pose(random)};
    std::vector<double> durations;
    const int segments = 1 + static_cast<int>(random() % 5);
    for (int i = 0; i < segments; ++i) {
      poses.push_back(random_pose(random));
      durations.push_back(seconds(random));
    }
    const DriveMotion motion(poses, durations, 0.2);
    EXPECT_LT((motion.at(0.0).pose.matrix() - poses.front().matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(
        (motion.at(motion.duration()).pose.matrix() - poses.back().matrix()).cwiseAbs().maxCoeff(),
        1e-12);
    for (size_t i = 1; i < motion.parts(); ++i) {
      ASSERT_NEAR(motion.start_of(i), motion.end_of(i - 1), 1e-12);
      const ToolState left = motion.at(i - 1, motion.end_of(i - 1));
      const ToolState right = motion.at(i, motion.start_of(i));
      EXPECT_LT((left.pose.matrix() - right.pose.matrix()).cwiseAbs().maxCoeff(), 1e-11);
      EXPECT_LT((left.velocity - right.velocity).norm(), 1e-10);
      EXPECT_LT((left.acceleration - right.acceleration).norm(), 1e-9);
    }
    if (testing::Test::HasFailure()) return;
  }
}

TEST(DriveMotion, DerivativesMatchFiniteDifferences) {
  const double h = 1e-5;
  int compared = 0;
  for (int seed = 0; seed < problems(300); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const std::array poses{random_pose(random), random_pose(random), random_pose(random)};
    const DriveMotion motion(poses, std::array{1.0, 1.0}, 0.4);
    for (size_t part = 0; part < motion.parts(); ++part) {
      const double t = 0.3 * motion.start_of(part) + 0.7 * motion.end_of(part);
      const ToolState left = motion.at(part, t - h), here = motion.at(part, t),
                      right = motion.at(part, t + h);
      const Eigen::Vector3d v = (right.pose.translation() - left.pose.translation()) / (2.0 * h);
      const Eigen::Vector3d w =
          rotation_log(right.pose.linear() * left.pose.linear().transpose()) / (2.0 * h);
      EXPECT_LT((v - here.velocity).norm(), 1e-6);
      EXPECT_LT((w - here.angular_velocity).norm(), 1e-6);
      EXPECT_LT(((right.velocity - left.velocity) / (2.0 * h) - here.acceleration).norm(), 1e-5);
      EXPECT_LT(
          ((right.angular_velocity - left.angular_velocity) / (2.0 * h) - here.angular_acceleration)
              .norm(),
          1e-5);
      ++compared;
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_EQ(compared, problems(900));
}

TEST(DriveMotion, RefusesTimesThatCannotBeLaidOut) {
  std::mt19937_64 random(1);
  const std::array poses{random_pose(random), random_pose(random), random_pose(random)};
  EXPECT_THROW(DriveMotion(poses, std::array{0.5, 0.1}, 0.2), MotionError);
  EXPECT_THROW(DriveMotion(poses, std::array{0.5}, 0.2), MotionError);
  EXPECT_THROW(DriveMotion(std::span(poses).first(1), {}, 0.2), MotionError);
  EXPECT_NO_THROW(DriveMotion(std::span(poses).first(2), std::array{0.5}, 0.2));
}

}  // namespace
}  // namespace viapoint
