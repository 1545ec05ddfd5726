/// @file
/// From a step of the program to its leg: inverse kinematics, straight lines, joint limits.
#pragma once

#include <vector>

#include "planning/leg.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/path/insertion.hpp"
#include "viapoint/path/task_curve.hpp"
#include "viapoint/planning/motion_planner.hpp"

namespace viapoint::planning {

/// Immutable; borrows the robot.
class LegBuilder {
 public:
  LegBuilder(const RobotModel& robot, const LineTolerance& tolerance)
      : robot_(robot), tolerance_(tolerance) {}

  /// Joints of a target; the branch nearest to `near` where it is a pose or a position.
  /// @throws MotionError: kBadArgument, kJointLimit, kCouplingLimit, kUncontrolled, kUnreachable…
  [[nodiscard]] JointVector resolve(const Target& target, const JointVector& near) const;
  /// Refuses joints of the wrong number, not finite, or outside the limits.
  void require_within_limits(const JointVector& q, const char* what) const;

  /// @throws MotionError; kZeroLength where the move goes nowhere
  [[nodiscard]] Leg ptp(const PtpMove& move, const JointVector& start) const;
  [[nodiscard]] Leg lin(const LinMove& move, const JointVector& start) const;

  /// Puts the wishes of a step on every piece of its leg.
  void apply(Leg& leg, const MoveOptions& options, int step) const;

 private:
  [[nodiscard]] Leg follow(const TaskCurve& curve, const JointVector& start,
                           const InsertionOptions& how) const;
  [[nodiscard]] Leg lin_by_wrist(const Target& target, const JointVector& start) const;
  [[nodiscard]] Pose pose_of(const Target& target, const JointVector& start) const;
  void require_arrival(const LinMove& move, const Leg& leg) const;

  const RobotModel& robot_;
  LineTolerance tolerance_;
};

}  // namespace viapoint::planning
