/// @file
/// From a step of the program to its leg: inverse kinematics, tool curves, joint limits.
#pragma once

#include <vector>

#include "planning/leg.hpp"
#include "planning/tool_way.hpp"
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
  /// @throws MotionError; kZeroLength where the move goes nowhere
  [[nodiscard]] Leg ptp(const PtpMove& move, const JointVector& start) const;
  [[nodiscard]] Leg lin(const LinMove& move, const JointVector& start) const;
  /// The same to these joints, to rounding; only where the arm leaves one coordinate open.
  /// @throws MotionError also where no such way is found
  [[nodiscard]] Leg lin_to(const LinMove& move, const JointVector& start,
                           const JointVector& goal) const;
  [[nodiscard]] Leg circ(const CircMove& move, const JointVector& start) const;
  [[nodiscard]] Leg turn(const TurnMove& move, const JointVector& start) const;
  [[nodiscard]] Leg spline(const SplineMove& move, const JointVector& start) const;
  /// Where a turn from `start` ends. @throws MotionError where it cannot be said
  [[nodiscard]] Target goal_of(const TurnMove& move, const JointVector& start) const;

  /// Puts the wishes of a step on every piece of its leg.
  void apply(Leg& leg, const MoveOptions& options, int step) const;

 private:
  [[nodiscard]] Leg follow(const TaskCurve& curve, const JointVector& start,
                           const InsertionOptions& how) const;
  [[nodiscard]] static Leg leg_of(const JointVector& start, Insertion inserted);
  [[nodiscard]] InsertionOptions options_for(Hold hold) const;
  [[nodiscard]] Leg travel(const ToolWay& way, const JointVector& start) const;
  [[nodiscard]] Leg travel_by_wrist(const ToolWay& way, const JointVector& start) const;
  /// Ends of the wrist joints to try, the nearest first.
  [[nodiscard]] std::vector<JointVector> wrist_ends(const Target& goal,
                                                    const JointVector& start) const;
  void require_arrival(const JointVector& wanted, const Leg& leg) const;

  const RobotModel& robot_;
  LineTolerance tolerance_;
};

}  // namespace viapoint::planning
