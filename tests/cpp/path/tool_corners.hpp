/// @file
/// Random corners between lines of the tool.
#pragma once

#include <optional>
#include <random>

#include "path/teaching_arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/path/insertion.hpp"

namespace viapoint::testing {

inline JointVector unit_vector(std::mt19937& random, int joints) {
  std::normal_distribution<double> normal;
  JointVector v(joints);
  for (int i = 0; i < joints; ++i) v[i] = normal(random);
  return v.normalized();
}

/// Two straight tool lines that meet, inserted on the PUMA.
struct ToolCorner {
  JointPath before, after;
  Pose corner;
};

inline std::optional<ToolCorner> tool_corner(const ForwardKinematics& arm, unsigned seed) {
  std::mt19937 random(seed);
  JointVector middle = random_joints(random, puma560_limits());
  middle[2] = (20.0 + 60.0 * (seed % 3) / 2.0) * kDegree;
  middle[4] = (30.0 + 40.0 * (seed % 5) / 4.0) * kDegree;
  const Pose pose = arm.pose(middle);
  const JointVector directions = unit_vector(random, 12);
  const auto end_of = [&](int i) {
    Pose end = pose;
    end.translation() += 0.3 * directions.segment<3>(i);
    end.rotate(rotation_exp(0.6 * Eigen::Vector3d(directions.segment<3>(i + 3))));
    return end;
  };
  const JointLimits limits = no_position_limits(6);
  ToolCorner result;
  result.corner = pose;
  try {
    const LineCurve back(pose, end_of(0));
    const JointVector start = insert_curve(arm, limits, back, middle, {}).knots.back();
    const Insertion first = insert_curve(arm, limits, LineCurve(end_of(0), pose), start, {});
    for (const JointPiece& piece : first.pieces) result.before.append(piece);
    const Insertion second =
        insert_curve(arm, limits, LineCurve(pose, end_of(6)), first.knots.back(), {});
    for (const JointPiece& piece : second.pieces) result.after.append(piece);
  } catch (const MotionError&) {
    return std::nullopt;
  }
  return result;
}

}  // namespace viapoint::testing
