/// @file
/// The deviation proof as insertion uses it: yes or no against a tolerance, without refining what
/// is already proven.
#pragma once

#include <optional>

#include "viapoint/path/insertion.hpp"

namespace viapoint {

/// What the angle of a deviation is taken of; of nothing it is 0.
enum class AngleOf { kNothing, kRotation, kAxis };

/// Of what a hold keeps.
[[nodiscard]] constexpr AngleOf angle_kept_by(Hold hold) {
  if (hold == Hold::kPose) return AngleOf::kRotation;
  return hold == Hold::kAxis ? AngleOf::kAxis : AngleOf::kNothing;
}

/// Angle between two directions of unit length [rad], exact where it is small.
[[nodiscard]] double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Proves that the piece stays within `tolerance` of the curve from s0 on, and returns the bound
/// found on the way (at most the tolerance); nothing when it leaves it, or when no proof is found
/// by a bounded search.
/// @param places counts on: how many places of the piece were looked at
[[nodiscard]] std::optional<Deviation> prove_deviation(const ForwardKinematics& arm,
                                                       const JointPiece& piece,
                                                       const TaskCurve& curve, double s0,
                                                       AngleOf angle_of, const Deviation& tolerance,
                                                       long& places);

/// The deviation at one s of the piece, not a bound.
[[nodiscard]] Deviation deviation_at(const ForwardKinematics& arm, const JointPiece& piece,
                                     const TaskCurve& curve, double s0, AngleOf angle_of, double s);

}  // namespace viapoint
