#include "viapoint/kinematics/calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

using Eigen::Vector3d;

Vector3d random_vector(std::mt19937_64& generator, double size) {
  std::uniform_real_distribution<double> along(-size, size);
  return {along(generator), along(generator), along(generator)};
}

Vector3d gaussian(std::mt19937_64& generator, double deviation) {
  std::normal_distribution<double> along(0.0, deviation);
  return {along(generator), along(generator), along(generator)};
}

Pose pose_of(const Vector3d& position, const Eigen::Matrix3d& rotation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = position;
  return pose;
}

Pose random_pose(std::mt19937_64& generator) {
  return pose_of(random_vector(generator, 1.0), rotation_exp(random_vector(generator, 1.5)));
}

/// A pose of the flange that holds the tool's point on `point`, tilted as `turn` says.
Pose touching(const Vector3d& point, const Pose& tool, const Eigen::Matrix3d& turn) {
  return pose_of(point - turn * tool.translation(), turn);
}

/// A tool, a point, and n touches of it, tilted by 20° to 60° about axes all around one direction,
/// as a person does it.
struct Session {
  Pose tool;
  Vector3d point;
  std::vector<Pose> touches;
  Pose along_x, along_z;

  Session(std::mt19937_64& generator, int n) {
    tool = random_pose(generator);
    tool.translation() *= 0.3;
    point = random_vector(generator, 1.0);
    const Eigen::Matrix3d upright = rotation_exp(random_vector(generator, 1.5));
    std::uniform_real_distribution<double> tilt(20.0 * kDegree, 60.0 * kDegree);
    std::uniform_real_distribution<double> slack(-0.3, 0.3);
    for (int i = 0; i < n; ++i) {
      const double about = 2.0 * kPi * i / n + slack(generator);
      const Vector3d axis(std::cos(about), std::sin(about), 0.0);
      touches.push_back(touching(point, tool, upright * rotation_exp(axis * tilt(generator))));
    }
    along_x = moved(0);
    along_z = moved(2);
  }

  /// The last touch, moved 100 mm along an axis of the tool.
  [[nodiscard]] Pose moved(int axis) const {
    Pose pose = touches.back();
    pose.translation() += 0.1 * (pose.linear() * tool.linear()).col(axis);
    return pose;
  }
};

/// The problem that a call raises; an empty one where it raises none.
template <typename Call>
Problem problem_of(const Call& call) {
  try {
    call();
  } catch (const MotionError& error) {
    return error.problem();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

TEST(Calibration, FindsAPlantedToolToRounding) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const Session session(generator, 4 + static_cast<int>(seed % 5));
    const ToolCalibration found = calibrate_tool(session.touches, session.along_x, session.along_z);
    ASSERT_LT((found.tcp.tcp - session.tool.translation()).norm(), 1e-9);
    ASSERT_LT((found.tcp.point - session.point).norm(), 1e-9);
    ASSERT_LT(rotation_distance(found.pose_flange_tool.linear(), session.tool.linear()), 1e-9);
    ASSERT_LT(found.tcp.fit.largest, 1e-9);
    ASSERT_NEAR(found.angle, kPi / 2.0, 1e-9);
    ASSERT_LT(found.tcp.sensitivity, kMostSensitivity);
  }
}

// The error along the direction known least is normal with the standard deviation that is told: its
// square over that variance has the mean 1. The residuals tell the noise without a bias.
TEST(Calibration, TellsTheErrorToExpectFromTheResiduals) {
  constexpr double kNoise = 1e-4;
  constexpr int kSessions = 4000;
  double squares = 0.0;
  double told = 0.0;
  int beyond = 0;
  for (unsigned seed = 0; seed < kSessions; ++seed) {
    std::mt19937_64 generator(seed);
    Session session(generator, 6);
    for (Pose& touch : session.touches) touch.translation() += gaussian(generator, kNoise);
    const TcpCalibration found = calibrate_tcp(session.touches);
    const double error = (found.tcp - session.tool.translation()).norm();
    // In all three directions together it is at most √3 times as large as in the worst one.
    const double deviation = found.sensitivity * kNoise;
    squares += error * error / (deviation * deviation);
    told += std::pow(found.uncertainty / deviation, 2);
    beyond += error > 4.0 * deviation ? 1 : 0;
  }
  const double mean_square = squares / kSessions;
  EXPECT_GT(mean_square, 1.0);
  EXPECT_LT(mean_square, 3.0);
  EXPECT_NEAR(told / kSessions, 1.0, 0.05);
  EXPECT_LT(beyond, kSessions / 1000);
}

TEST(Calibration, MoreTouchesTellMore) {
  std::mt19937_64 generator(7);
  double before = HUGE_VAL;
  for (const int n : {4, 8, 16, 32}) {
    const double now = calibrate_tcp(Session(generator, n).touches).sensitivity;
    EXPECT_LT(now, before);
    before = now;
  }
}

TEST(Calibration, NamesTheTouchThatDoesNotFit) {
  std::mt19937_64 generator(3);
  Session session(generator, 8);
  session.touches[5].translation() += Vector3d(0.0, 0.005, 0.0);
  const Fit fit = calibrate_tcp(session.touches).fit;
  EXPECT_EQ(fit.worst, 5);
  EXPECT_EQ(fit.residuals.size(), 8u);
  EXPECT_DOUBLE_EQ(fit.largest, fit.residuals[5]);
  EXPECT_GT(fit.rms, 1e-3);
}

TEST(Calibration, RefusesParallelOrientationsByTheirAxis) {
  const Vector3d axis = Vector3d(1.0, 2.0, 2.0).normalized();
  const Pose tool = pose_of({0.1, 0.2, 0.3}, Eigen::Matrix3d::Identity());
  std::vector<Pose> touches;
  for (const double angle : {0.0, 0.7, 1.4, 2.1, 2.8}) {
    touches.push_back(touching({0.5, 0.0, 0.2}, tool, rotation_exp(axis * angle)));
  }
  const Problem problem = problem_of([&] { (void)calibrate_tcp(touches); });
  EXPECT_EQ(problem.code, ErrorCode::kDegeneratePoints);
  EXPECT_NE(problem.message.find("parallel"), std::string::npos) << problem.message;
  EXPECT_NE(problem.message.find("0.667"), std::string::npos) << problem.message;
  EXPECT_NE(problem.ways_out.at(0).find("tilt that axis"), std::string::npos);
  // Tilted in one of them, the tool is known.
  touches[2] =
      touching({0.5, 0.0, 0.2}, tool, rotation_exp(Vector3d(0.8, 0.0, 0.0)) * touches[2].linear());
  EXPECT_LT((calibrate_tcp(touches).tcp - tool.translation()).norm(), 1e-9);
}

TEST(Calibration, RefusesOrientationsThatAreTooMuchAlikeByTheirSpread) {
  const Pose tool = pose_of({0.0, 0.0, 0.2}, Eigen::Matrix3d::Identity());
  const auto tilted = [&](double tilt) {
    std::vector<Pose> touches;
    for (const double about : {0.0, 1.5, 3.0, 4.5}) {
      const Vector3d axis(std::cos(about), std::sin(about), 0.0);
      touches.push_back(touching({0.5, 0.0, 0.2}, tool, rotation_exp(axis * tilt)));
    }
    return touches;
  };
  const Problem problem = problem_of([&] { (void)calibrate_tcp(tilted(2.0 * kDegree)); });
  EXPECT_EQ(problem.code, ErrorCode::kDegeneratePoints);
  EXPECT_NE(problem.message.find("alike"), std::string::npos) << problem.message;
  EXPECT_NE(problem.message.find("differ by 3.99°"), std::string::npos) << problem.message;
  EXPECT_GT(problem.value.value(), problem.limit.value());
  EXPECT_LE(calibrate_tcp(tilted(15.0 * kDegree)).sensitivity, kMostSensitivity);
  // The very same pose again and again.
  EXPECT_EQ(problem_of([&] { (void)calibrate_tcp(tilted(0.0)); }).code,
            ErrorCode::kDegeneratePoints);
}

TEST(Calibration, RefusesTooFewTouchesAndWhatIsNoPose) {
  std::mt19937_64 generator(1);
  Session session(generator, 4);
  session.touches.pop_back();
  EXPECT_EQ(problem_of([&] { (void)calibrate_tcp(session.touches); }).code,
            ErrorCode::kBadArgument);
  session.touches.push_back(pose_of({NAN, 0.0, 0.0}, Eigen::Matrix3d::Identity()));
  EXPECT_EQ(problem_of([&] { (void)calibrate_tcp(session.touches); }).code,
            ErrorCode::kBadArgument);
}

TEST(Calibration, RefusesWaysThatShowNoTwoDirections) {
  std::mt19937_64 generator(2);
  const Session session(generator, 5);
  const Problem one_line =
      problem_of([&] { (void)calibrate_tool(session.touches, session.along_x, session.along_x); });
  EXPECT_EQ(one_line.code, ErrorCode::kDegeneratePoints);
  EXPECT_NE(one_line.message.find("one direction"), std::string::npos) << one_line.message;
  const Problem still = problem_of(
      [&] { (void)calibrate_tool(session.touches, session.touches.back(), session.along_z); });
  EXPECT_EQ(still.code, ErrorCode::kDegeneratePoints);
  EXPECT_NE(still.message.find("tool's x"), std::string::npos) << still.message;
}

TEST(Calibration, TakesZAsItWasShownAndSquaresX) {
  std::mt19937_64 generator(4);
  Session session(generator, 5);
  session.along_x.translation() +=
      0.01 * (session.touches.back().linear() * session.tool.linear()).col(2);
  const ToolCalibration found = calibrate_tool(session.touches, session.along_x, session.along_z);
  EXPECT_LT(rotation_distance(found.pose_flange_tool.linear(), session.tool.linear()), 1e-9);
  EXPECT_NEAR(found.angle, kPi / 2.0 - std::atan(0.1), 1e-9);
}

TEST(Calibration, FindsAFrameFromThreePoints) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const Pose planted = random_pose(generator);
    std::uniform_real_distribution<double> along(0.05, 1.0);
    const Vector3d on_x(along(generator), 0.0, 0.0);
    const Vector3d on_xy(along(generator) - 0.5, along(generator), 0.0);
    const Pose found = frame_from_points(planted.translation(), planted * on_x, planted * on_xy);
    ASSERT_LT((found.matrix() - planted.matrix()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Calibration, RefusesPointsOnOneLineByTheirAngle) {
  const Vector3d origin(0.1, 0.2, 0.3);
  const Vector3d on_x = origin + Vector3d(0.5, 0.0, 0.0);
  for (const Vector3d& third :
       {Vector3d(origin + Vector3d(0.9, 0.0, 0.0)), Vector3d(origin - Vector3d(0.9, 0.0, 0.0)),
        Vector3d(origin + Vector3d(0.5, 0.01, 0.0))}) {
    const Problem problem = problem_of([&] { (void)frame_from_points(origin, on_x, third); });
    EXPECT_EQ(problem.code, ErrorCode::kDegeneratePoints);
    EXPECT_NE(problem.message.find("one line"), std::string::npos) << problem.message;
    EXPECT_LT(problem.value.value(), problem.limit.value());
  }
  EXPECT_EQ(problem_of([&] { (void)frame_from_points(origin, origin, on_x); }).code,
            ErrorCode::kDegeneratePoints);
}

TEST(Calibration, FindsAFrameFromKnownPoints) {
  for (unsigned seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const Pose planted = random_pose(generator);
    std::vector<Vector3d> known;
    std::vector<Vector3d> touched;
    for (unsigned i = 0; i < 3 + seed % 4; ++i) {
      // In one plane, where a reflection fits as well as the rotation does.
      known.emplace_back(random_vector(generator, 0.5).cwiseProduct(Vector3d(1.0, 1.0, 0.0)));
      touched.emplace_back(planted * known.back());
    }
    FrameFit found;
    try {
      found = frame_from_known_points(known, touched);
    } catch (const MotionError& error) {  // three random points may lie on one line
      ASSERT_EQ(error.code(), ErrorCode::kDegeneratePoints);
      continue;
    }
    ASSERT_LT((found.pose_base_frame.matrix() - planted.matrix()).cwiseAbs().maxCoeff(), 1e-9);
    ASSERT_LT(found.fit.largest, 1e-9);
  }
}

TEST(Calibration, RefusesKnownPointsThatTellNoFrame) {
  const std::vector<Vector3d> line = {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.4, 0.001, 0.0}};
  const Problem problem = problem_of([&] { (void)frame_from_known_points(line, line); });
  EXPECT_EQ(problem.code, ErrorCode::kDegeneratePoints);
  EXPECT_NE(problem.message.find("one line"), std::string::npos) << problem.message;
  const std::vector<Vector3d> same(3, Vector3d(0.1, 0.0, 0.0));
  EXPECT_EQ(problem_of([&] { (void)frame_from_known_points(same, same); }).code,
            ErrorCode::kDegeneratePoints);
  const std::vector<Vector3d> good = {{0.0, 0.0, 0.0}, {0.3, 0.0, 0.0}, {0.0, 0.3, 0.0}};
  for (const auto& touched : {same, line}) {
    const Problem told = problem_of([&] { (void)frame_from_known_points(good, touched); });
    EXPECT_EQ(told.code, ErrorCode::kDegeneratePoints);
    EXPECT_NE(told.message.find("touched"), std::string::npos) << told.message;
  }
  EXPECT_EQ(problem_of([&] { (void)frame_from_known_points(line, std::span(line).first(2)); }).code,
            ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace viapoint
