/// @file
/// Lines that begin close by the singular wrist, where joints 4 and 6 turn against each other
/// without moving the tool: the joints must follow the curve, not only the tool.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "path/insertion_checks.hpp"
#include "problem_count.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint {
namespace {

using testing::expect_sound;
using testing::problem_of;
using testing::RandomLine;

constexpr unsigned kLines = problems(2000U);

/// Joints at increasing s.
struct Track {
  std::vector<double> s;
  std::vector<JointVector> q;
  bool complete = false;
};

/// Newton's method with the inverse of the whole Jacobian, in steps in which no joint moves by more
/// than `most` [rad]. Stops, incomplete, where such steps become too short for doubles.
Track track_densely(const ForwardKinematics& arm, const TaskCurve& curve, const JointVector& start,
                    double most) {
  Track track;
  track.s.push_back(0.0);
  track.q.push_back(start);
  const double length = curve.length();
  double step = 1e-13 * length;
  double s = 0.0;
  JointVector q = start;
  while (s < length) {
    const double next = std::min(s + step, length);
    const CurvePoint wanted = curve.at(next);
    JointVector trial = q;
    double size = 1.0;
    for (int i = 0; i < 8 && size > 1e-13; ++i) {
      const ChainFrames frames = arm.frames(trial);
      Eigen::Matrix<double, 6, 1> miss;
      miss << wanted.p - frames.pose_base_tool.translation(),
          rotation_log(wanted.rotation * frames.pose_base_tool.linear().transpose());
      size = miss.norm();
      const Eigen::Matrix<double, 6, 6> jacobian = arm.jacobian(frames);
      trial += jacobian.partialPivLu().solve(miss);
      if (!((trial - q).lpNorm<Eigen::Infinity>() <= 2.0 * most)) break;
    }
    const double moved = (trial - q).lpNorm<Eigen::Infinity>();
    if (!(moved <= most) || !(size <= 1e-10)) {
      step *= 0.5;
      if (step < 1e-14 * length) return track;
      continue;
    }
    s = next;
    q = trial;
    track.s.push_back(s);
    track.q.push_back(q);
    step = std::min(step * (moved < 0.5 * most ? 1.3 : 1.0), 4e-3 * length);
  }
  track.complete = true;
  return track;
}

/// How far each joint sweeps over the pieces.
JointVector sweep_of(const std::vector<JointPiece>& pieces) {
  JointVector low = pieces.front().at(0.0).q;
  JointVector high = low;
  for (const JointPiece& piece : pieces) {
    for (int i = 0; i <= 50; ++i) {
      const JointVector q = piece.at(piece.length * i / 50).q;
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
  }
  return high - low;
}

JointVector sweep_of(const Track& track) {
  JointVector low = track.q.front();
  JointVector high = low;
  for (const JointVector& q : track.q) {
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  return high - low;
}

/// A line in a random direction from joints whose joint 5 is between 1e-9 and 1e-3.
RandomLine line_from_singular_wrist(const ForwardKinematics& arm, unsigned seed) {
  std::mt19937 random(seed);
  JointVector start = testing::random_joints(random, testing::puma560_limits());
  start[4] = std::pow(10.0, std::uniform_real_distribution<double>(-9.0, -3.0)(random));
  std::normal_distribution<double> normal;
  Eigen::Vector3d travel(normal(random), normal(random), normal(random));
  travel *=
      std::pow(10.0, std::uniform_real_distribution<double>(-3.0, -0.7)(random)) / travel.norm();
  const Pose from = arm.pose(start);
  return {start, LineCurve::fixed_orientation(from, from.translation() + travel)};
}

TEST(WristSingularity, JointsTurnNoFartherThanFollowingTheLineTakes) {
  const ForwardKinematics arm = testing::puma560();
  const JointLimits limits = testing::no_position_limits(6);
  int same = 0;
  int flipped = 0;
  int refused = 0;
  for (unsigned seed = 0; seed < kLines; ++seed) {
    SCOPED_TRACE(seed);
    const RandomLine line = line_from_singular_wrist(arm, seed);
    Insertion found;
    try {
      found = insert_curve(arm, limits, line.curve, line.start, {});
    } catch (const MotionError& error) {
      ASSERT_TRUE(error.code() == ErrorCode::kUnreachable || error.code() == ErrorCode::kSingular)
          << error.what();
      if (error.code() == ErrorCode::kSingular) ++refused;
      continue;
    }
    ASSERT_NO_FATAL_FAILURE(expect_sound(arm, limits, line.curve, found, {}, 20));
    const Track track = track_densely(arm, line.curve, line.start, 0.05);
    ASSERT_TRUE(track.complete);
    const JointVector longer = sweep_of(found.pieces) - sweep_of(track);
    ASSERT_LT(longer.maxCoeff(), 0.1) << longer.transpose();
    // The end is that of the dense track, or its other wrist: a line that leads nearly through
    // q5 = 0 may go straight on there, within the tolerance of the angle, where q4 would turn half.
    const JointVector& end = found.knots.back();
    JointVector other = track.q.back();
    other[4] = -other[4];
    for (const int i : {3, 5}) other[i] += other[i] < end[i] ? kPi : -kPi;
    if ((end - track.q.back()).lpNorm<Eigen::Infinity>() < 0.01) {
      ++same;
    } else {
      ASSERT_LT((end - other).lpNorm<Eigen::Infinity>(), 0.01)
          << end.transpose() << " or " << track.q.back().transpose();
      ++flipped;
    }
  }
  EXPECT_GT(same, static_cast<int>(kLines * 3 / 4));
  EXPECT_LT(flipped, static_cast<int>(kLines / 40));
  EXPECT_LT(refused, static_cast<int>(kLines / 10));
}

TEST(WristSingularity, DoesNotSpinJoint4HoweverSmallQ5Is) {
  const ForwardKinematics arm = testing::puma560();
  JointVector start(6);
  start << 2.6, -0.47, 0.035, 2.0, 1e-6, -0.086;
  for (const double q5 : {1e-3, 1e-5, 1e-6, 1e-7}) {
    SCOPED_TRACE(q5);
    start[4] = q5;
    const Pose from = arm.pose(start);
    const LineCurve curve = LineCurve::fixed_orientation(
        from, from.translation() + Eigen::Vector3d(0.004, 0.026, -0.016));
    const Insertion found = insert_curve(arm, testing::no_position_limits(6), curve, start, {});
    const Track track = track_densely(arm, curve, start, 0.01);
    ASSERT_TRUE(track.complete);
    EXPECT_LT((sweep_of(found.pieces) - sweep_of(track)).maxCoeff(), 0.05);
    EXPECT_LT((found.knots.back() - track.q.back()).lpNorm<Eigen::Infinity>(), 1e-3);
    EXPECT_LT(found.pieces.size(), 40u);
  }
}

/// A curve that counts how often it is asked for a point.
class CountedCurve final : public TaskCurve {
 public:
  explicit CountedCurve(const TaskCurve& curve) : curve_(curve) {}
  [[nodiscard]] double length() const override { return curve_.length(); }
  [[nodiscard]] CurvePoint at(double s) const override {
    ++points_;
    return curve_.at(s);
  }
  [[nodiscard]] CurveBounds bounds(double s0, double s1) const override {
    return curve_.bounds(s0, s1);
  }
  [[nodiscard]] long points() const { return points_; }

 private:
  const TaskCurve& curve_;
  mutable long points_ = 0;
};

/// How many points of the curve insertion looks at, whatever comes of it.
long points_asked(const ForwardKinematics& arm, const JointLimits& limits, const RandomLine& line) {
  const CountedCurve curve(line.curve);
  (void)problem_of(arm, limits, curve, line.start);
  return curve.points();
}

TEST(WristSingularity, LooksAtABoundedNumberOfPoints) {
  // Ten times what is measured; a search without bounds looks at millions.
  constexpr long kMost = 20000;
  const ForwardKinematics arm = testing::puma560();
  JointVector start(6);
  start << 0.066, 1.966, -1.677, 2.193, 2.6e-9, -0.491;
  const Pose from = arm.pose(start);
  const RandomLine known = {start,
                            LineCurve::fixed_orientation(
                                from, from.translation() + Eigen::Vector3d(0.017, 0.011, 0.009))};
  EXPECT_LT(points_asked(arm, testing::puma560_limits(), known), kMost);
  EXPECT_LT(points_asked(arm, testing::no_position_limits(6), known), kMost);
  JointLimits wide = testing::puma560_limits();
  wide.position_min.setConstant(-20.0);
  wide.position_max.setConstant(20.0);
  for (unsigned seed = 0; seed < kLines; ++seed) {
    SCOPED_TRACE(seed);
    const RandomLine line = line_from_singular_wrist(arm, seed);
    ASSERT_LT(points_asked(arm, testing::puma560_limits(), line), kMost);
    ASSERT_LT(points_asked(arm, wide, line), kMost);
  }
}

/// A curve that says of itself that it may bend beyond all measure: nothing is ever proven of it.
class WildCurve final : public TaskCurve {
 public:
  explicit WildCurve(const TaskCurve& curve, double third) : curve_(curve), third_(third) {}
  [[nodiscard]] double length() const override { return curve_.length(); }
  [[nodiscard]] CurvePoint at(double s) const override { return curve_.at(s); }
  [[nodiscard]] CurveBounds bounds(double s0, double s1) const override {
    CurveBounds bounds = curve_.bounds(s0, s1);
    bounds.p3 += third_;
    return bounds;
  }

 private:
  const TaskCurve& curve_;
  double third_;
};

TEST(WristSingularity, RefusesACurveThatTakesEndlessWork) {
  const ForwardKinematics arm = testing::puma560();
  const JointVector& start = testing::joints_a();
  const Pose from = arm.pose(start);
  const LineCurve line =
      LineCurve::fixed_orientation(from, from.translation() + Eigen::Vector3d(0.0, 0.05, 0.05));
  const JointLimits limits = testing::no_position_limits(6);
  const CountedCurve mild(line);
  ASSERT_FALSE(problem_of(arm, limits, mild, start));
  for (const double third : {1e15, 1e18}) {
    SCOPED_TRACE(third);
    const WildCurve wild(line, third);
    const CountedCurve counted(wild);
    const auto problem = problem_of(arm, limits, counted, start);
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->code, ErrorCode::kBadArgument) << problem->message;
    EXPECT_EQ(problem->ways_out.size(), 2u);
    EXPECT_LT(counted.points(), 100000);
    EXPECT_GT(counted.points(), 10 * mild.points());
  }
}

}  // namespace
}  // namespace viapoint
