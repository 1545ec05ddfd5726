/// @file
/// The deviation proof as insertion uses it: yes or no against a tolerance, without refining what
/// is already proven.
#pragma once

#include <optional>

#include "viapoint/path/insertion.hpp"

namespace viapoint {

/// Proves that the piece stays within `tolerance` of the curve from s0 on, and returns the bound
/// found on the way (at most the tolerance); nothing when it leaves it, or when no proof is found
/// by a bounded search.
/// An infinite angle tolerance leaves the rotation aside.
/// @param places counts on: how many places of the piece were looked at
[[nodiscard]] std::optional<Deviation> prove_deviation(const ForwardKinematics& arm,
                                                       const JointPiece& piece,
                                                       const TaskCurve& curve, double s0,
                                                       const Deviation& tolerance, long& places);

/// The deviation at one s of the piece, not a bound.
[[nodiscard]] Deviation deviation_at(const ForwardKinematics& arm, const JointPiece& piece,
                                     const TaskCurve& curve, double s0, double s);

}  // namespace viapoint
