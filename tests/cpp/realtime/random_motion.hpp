/// @file
/// Motions to run: random ones, each seeded, under limits that they use up.
#pragma once

#include <random>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

struct Motion {
  JointLimits limits;
  Trajectory trajectory;
};

/// Limits without position bounds, n joints alike.
[[nodiscard]] JointLimits even_limits(int joints, double velocity, double acceleration,
                                      double jerk);
/// The quickest straight move from `start` by `step`: every phase is at some limit.
void append_straight(std::vector<TrajectoryPiece>& pieces, const JointVector& start,
                     const JointVector& step, const JointLimits& limits, int move);
/// A stand at `position`.
void append_wait(std::vector<TrajectoryPiece>& pieces, const JointVector& position, double seconds,
                 int move);
/// Under limits of velocity, acceleration and jerk that the pieces just reach.
[[nodiscard]] Motion motion_at_its_limits(std::vector<TrajectoryPiece> pieces);
/// A stay, moves to random points, stops between them, random limits.
[[nodiscard]] Motion straight_motion(std::mt19937& random);
/// A C² curve through random states without a stop; each limit is just what the curve reaches.
[[nodiscard]] Motion curved_motion(std::mt19937& random);
/// Moves to and fro of some 1e-8 rad: pieces of 12 us, some 170 to 2 ms.
[[nodiscard]] Motion dense_motion(int moves);
/// Either straight or curved.
[[nodiscard]] Motion random_motion(std::mt19937& random);

}  // namespace viapoint
