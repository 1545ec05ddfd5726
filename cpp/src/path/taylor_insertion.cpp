#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "path/curve_follower.hpp"

namespace viapoint {
namespace {

/// Knots nearer than 2⁻²⁴ of the curve whose joint midpoint is still off: no bisection ends that.
constexpr int kDeepest = 24;

class TaylorBisection {
 public:
  TaylorBisection(const ForwardKinematics& arm, const TaskCurve& curve, const JointVector& start,
                  const InsertionOptions& options)
      : arm_(arm), curve_(curve), options_(options), follower_(arm, curve, start, options) {
    result_.s.push_back(0.0);
    result_.knots.push_back(start);
  }

  TaylorKnots run(const JointVector& goal) {
    const JointVector start = result_.knots.front();
    split(0.0, start, curve_.length(), goal, 0);
    return std::move(result_);
  }

 private:
  /// Appends the knots after s0 up to and with s1.
  void split(double s0, const JointVector& q0, double s1, const JointVector& q1, int depth) {
    const double middle = 0.5 * (s0 + s1);
    const JointVector q_middle = 0.5 * (q0 + q1);
    const Pose pose = arm_.pose(q_middle);
    const CurvePoint wanted = curve_.at(middle);
    const double position = (pose.translation() - wanted.p).norm();
    const double angle = rotation_distance(wanted.rotation, pose.linear());
    if (position <= options_.position_tolerance && angle <= options_.angle_tolerance) {
      result_.at_midpoints.position = std::max(result_.at_midpoints.position, position);
      result_.at_midpoints.angle = std::max(result_.at_midpoints.angle, angle);
      result_.s.push_back(s1);
      result_.knots.push_back(q1);
      return;
    }
    const double share = middle / curve_.length();
    if (depth >= kDeepest) {
      refuse(ErrorCode::kBranchChange, share,
             "bisection does not end: start and goal are on different branches");
    }
    const auto knot = follower_.solve(middle, q_middle);
    if (!knot) {
      refuse(ErrorCode::kSingular, share, "no joints found near the joint midpoint");
    }
    split(s0, q0, middle, knot->point.q, depth + 1);
    split(middle, knot->point.q, s1, q1, depth + 1);
  }

  [[noreturn]] static void refuse(ErrorCode code, double share, std::string message) {
    Problem problem;
    problem.code = code;
    problem.message = std::move(message);
    problem.share = share;
    problem.ways_out = {"use insert_curve, which follows the branch of the start",
                        "use a joint move for this leg"};
    throw MotionError(std::move(problem));
  }

  const ForwardKinematics& arm_;
  const TaskCurve& curve_;
  InsertionOptions options_;
  CurveFollower follower_;
  TaylorKnots result_;
};

}  // namespace

TaylorKnots taylor_insertion(const ForwardKinematics& arm, const TaskCurve& curve,
                             const JointVector& start, const JointVector& goal,
                             double position_tolerance, double angle_tolerance) {
  if (start.size() != arm.joints() || goal.size() != arm.joints()) {
    throw MotionError(ErrorCode::kBadArgument, "the arm has " + std::to_string(arm.joints()) +
                                                   " joints, the start " +
                                                   std::to_string(start.size()) + ", the goal " +
                                                   std::to_string(goal.size()));
  }
  if (!(position_tolerance > 0.0) || !(angle_tolerance > 0.0)) {
    throw MotionError(ErrorCode::kBadArgument, "insertion tolerances must be above zero");
  }
  if (!(curve.length() > 0.0)) {
    throw MotionError(ErrorCode::kZeroLength, "the curve goes nowhere");
  }
  InsertionOptions options;
  options.position_tolerance = position_tolerance;
  options.angle_tolerance = angle_tolerance;
  return TaylorBisection(arm, curve, start, options).run(goal);
}

}  // namespace viapoint
