/// @file
/// The name of one solution among all that reach a pose: on which side of each of its singularities
/// the arm stands, and how many whole turns its joints have made.
#pragma once

#include <string>

#include "viapoint/core/joint_vector.hpp"

namespace viapoint {

/// Whole turns, one a joint, (n,).
using TurnVector = Eigen::Matrix<int, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJoints, 1>;

/// Each side is +1 or -1, and changes at its own singularity only; 0 is the singularity itself, or
/// an arm without that choice. In a wish 0 and an empty `turns` stand for any.
struct Configuration {
  int shoulder = 0;  ///< +1 front, -1 back: the wrist before or behind axis 1
  int elbow = 0;     ///< +1 up, -1 down: as seen with the shoulder in front
  int wrist = 0;     ///< +1 no flip, -1 flip: the sign of the wrist's bend
  TurnVector turns;  ///< k with q in (-π, π] + 2π k; 0 for joints that slide

  /// True when this configuration has every side and turn that `wish` names; a singular side fits
  /// any. Real-time: safe.
  [[nodiscard]] bool fits(const Configuration& wish) const;
  /// "front, up, flip"; with turns "front, up, flip, turns 0 0 0 0 0 1".
  [[nodiscard]] std::string describe() const;
};

}  // namespace viapoint
