/// @file
/// Rounds the corner between two legs in joint space: one quintic that takes over q, q' and q'' of
/// both (C²), with its inner control points on the corner, so that the middle is sharp and the
/// cut-back long: that is what makes a corner quick when jerk is limited.
#pragma once

#include "viapoint/core/zone.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint {

/// A corner that keeps its zone.
struct Corner {
  bool possible = false;       ///< false: near reversal or no room; stop at the point
  std::string reason;          ///< why not possible, or why smaller than asked; empty otherwise
  bool short_of_room = false;  ///< the legs are too short for the whole zone
  double cut_before = 0.0;     ///< s taken off the end of the leg before
  double cut_after = 0.0;      ///< s taken off the start of the leg after (its own, unscaled s)
  double scale_after = 1.0;  ///< multiply every length (of s) of the leg after by this, so that q'
                             ///< is continuous along the section
  JointPiece blend;          ///< kind kBlend; from leg_before.length() - cut_before
  double used = 0.0;         ///< size used, in the zone's own unit, proven
  double used_angle = 0.0;   ///< the same of its angle [rad]; 0 for a zone without
  bool angle_rules = false;  ///< its angle is used up before its size, or leaves no corner at all
  double tool_deviation = 0.0;  ///< proven largest distance, both ways, from the legs at the tool
                                ///< [m]; 0 for an arm without kinematics
};

/// The largest corner within the zone and the room left. Radius: each leg is cut where the tool is
/// that far from the corner, and blend and cut parts stay within it. Deviations: both legs are cut
/// equally far back in joint distance, as far as the zone allows. A leg without the room is cut
/// less, and the other at most four times as far back in joint distance. What is said to be kept is
/// proven by Taylor bounds over every interval (src/path/corner_shape.hpp), and at least 99 % of
/// the zone, or of its angle, is used where nothing else limits the corner. Joints blend as one, so
/// the bound that is used up first decides how far back both position and orientation are cut. Rate
/// limits and scale of the blend are the caller's. Real-time: not. Threads: any.
/// @param arm null for an arm without kinematics (then only joint zones are possible)
/// @param room_before, room_after largest cuts allowed on each leg, in its own s
/// @throws MotionError kDiscontinuous (the legs do not meet), kBadArgument (a leg without pieces)
[[nodiscard]] Corner round_corner(const ForwardKinematics* arm, const JointPath& before,
                                  const JointPath& after, const Zone& zone, double room_before,
                                  double room_after);

}  // namespace viapoint
