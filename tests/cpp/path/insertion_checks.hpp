/// @file
/// What every insertion must keep, checked on samples of its own, and the lines it is tried on.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "path/teaching_arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint::testing {

/// Textbook §3: printed joints of the poses A, B and C.
inline const JointVector& joints_a() {
  static const JointVector q =
      joints_in_degrees({-100.4577, 70.6108, 48.3997, 0, 60.9896, 29.2746});
  return q;
}
inline const JointVector& joints_b() {
  static const JointVector q =
      joints_in_degrees({-52.1158, -1.4358, 30.206, -121.3834, -11.4781, -178.4572});
  return q;
}
inline const JointVector& joints_c() {
  static const JointVector q =
      joints_in_degrees({0.0955, 65.7969, 14.3196, 15.3377, -20.173, 30.0401});
  return q;
}

/// The problem that insertion finds, or nothing.
inline std::optional<Problem> problem_of(const ForwardKinematics& arm, const JointLimits& limits,
                                         const TaskCurve& curve, const JointVector& start,
                                         const InsertionOptions& options = {}) {
  try {
    (void)insert_curve(arm, limits, curve, start, options);
  } catch (const MotionError& error) {
    return error.problem();
  }
  return std::nullopt;
}

/// True deviation of a piece by dense samples: the angle of the tool's axis or of its rotation.
inline Deviation sampled(const ForwardKinematics& arm, const JointPiece& piece,
                         const TaskCurve& curve, double s0, int samples, Hold hold = Hold::kPose) {
  Deviation worst;
  for (int i = 0; i <= samples; ++i) {
    const double s = piece.length * i / samples;
    const Pose pose = arm.pose(piece.at(s).q);
    const CurvePoint wanted = curve.at(std::min(s0 + s, curve.length()));
    worst.position = std::max(worst.position, (pose.translation() - wanted.p).norm());
    const double angle =
        hold == Hold::kAxis
            ? std::asin(std::min(1.0, wanted.rotation.col(2).cross(pose.linear().col(2)).norm()))
            : rotation_distance(wanted.rotation, pose.linear());
    worst.angle = std::max(worst.angle, angle);
  }
  return worst;
}

/// Everything that an insertion promises, checked on samples of its own.
inline void expect_sound(const ForwardKinematics& arm, const JointLimits& limits,
                         const TaskCurve& curve, const Insertion& found,
                         const InsertionOptions& options, int samples) {
  ASSERT_EQ(found.knots.size(), found.pieces.size() + 1);
  double s0 = 0.0;
  for (size_t k = 0; k < found.pieces.size(); ++k) {
    const JointPiece& piece = found.pieces[k];
    ASSERT_EQ(piece.kind, PieceKind::kCurve);
    const Deviation worst = sampled(arm, piece, curve, s0, samples, options.hold);
    constexpr double kRounding = 1e-14;
    ASSERT_LE(worst.position, piece.position_deviation + kRounding) << "piece " << k;
    ASSERT_LE(piece.position_deviation, options.position_tolerance);
    ASSERT_LE(piece.position_deviation, found.position_deviation);
    if (options.hold == Hold::kPose || options.hold == Hold::kAxis) {
      ASSERT_LE(worst.angle, piece.angle_deviation + 1e-13) << "piece " << k;
      ASSERT_LE(piece.angle_deviation, options.angle_tolerance);
      ASSERT_LE(piece.angle_deviation, found.angle_deviation);
    }
    for (int i = 0; i <= samples; ++i) {
      ASSERT_TRUE(limits.contains(piece.at(piece.length * i / samples).q, 2e-9)) << "piece " << k;
    }
    ASSERT_LT((piece.at(0.0).q - found.knots[k]).norm(), 1e-12);
    ASSERT_LT((piece.at(piece.length).q - found.knots[k + 1]).norm(), 1e-12);
    if (k > 0) {
      const JointPiece& before = found.pieces[k - 1];
      const PathPoint end = before.at(before.length);
      const PathPoint start = piece.at(0.0);
      ASSERT_LT((end.q1 - start.q1).norm(), 1e-10 * (1.0 + start.q1.norm()));
      ASSERT_LT((end.q2 - start.q2).norm(), 1e-8 * (1.0 + start.q2.norm()));
    }
    s0 += piece.length;
  }
  ASSERT_NEAR(s0, curve.length(), 1e-12);
}

/// A line from a random place to another at most this far off in joints.
struct RandomLine {
  JointVector start;
  LineCurve curve;
};
inline RandomLine random_line(const ForwardKinematics& arm, const JointLimits& limits,
                              unsigned seed, double spread) {
  std::mt19937 random(seed);
  const JointVector start = testing::random_joints(random, limits);
  const JointVector end = testing::random_joints(random, limits);
  return {start, LineCurve(arm.pose(start), arm.pose(start + spread * (end - start)))};
}

}  // namespace viapoint::testing
