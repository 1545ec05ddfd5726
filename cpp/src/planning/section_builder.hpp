/// @file
/// The geometry of a motion, leg by leg: every corner is decided as soon as the legs that it hangs
/// on are known, and stays as it is.
#pragma once

#include <optional>
#include <vector>

#include "planning/leg.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"

namespace viapoint::planning {

/// A stretch of path from rest, or from where the last stretch of the same section ended.
struct SectionPart {
  JointPath path;
  std::vector<CornerOutcome> corners;  ///< decided in it, in order
  bool ends = false;                   ///< the arm rests at its end
};

/// Rounds every corner whose zone asks for it. A corner that cannot be rounded, or where stopping
/// is quicker, becomes a stop, and its outcome says why. How far a corner may reach into the leg
/// after it hangs on whether that leg has a corner at its other end: so each waits for one more leg
/// than the two it joins.
class SectionBuilder {
 public:
  /// @param robot with the tool of all legs; must outlive this
  explicit SectionBuilder(const RobotModel& robot) : robot_(robot) {}

  void add(Leg leg);
  /// The arm rests after the last leg.
  void end();
  /// What has been decided since the last call; the last part may go on.
  [[nodiscard]] std::vector<SectionPart> take();
  /// What follows the last part whatever comes: the stretch that no corner can cut off. Empty
  /// without a leg under way.
  [[nodiscard]] JointPath certain() const;

 private:
  /// Rounds the corner between the present leg and the next, or comes to rest there.
  void turn(bool corner_after);
  [[nodiscard]] bool round(bool corner_after);
  void stop(CornerOutcome outcome);
  /// What became of the points that the present leg was merged of.
  void tell_merged();
  [[nodiscard]] double gain_of(const JointPath& head, const JointPiece& blend,
                               const JointPath& rest) const;
  void append_blend(const JointPiece& blend, int step_before, int step_after);
  /// The present leg ends at rest.
  void finish();
  SectionPart& part();

  const RobotModel& robot_;
  std::optional<Leg> leg_;   ///< the present one
  JointPath tail_;           ///< what is left of it
  std::optional<Leg> next_;  ///< whose corner with the present one is open
  std::vector<SectionPart> parts_;
};

}  // namespace viapoint::planning
