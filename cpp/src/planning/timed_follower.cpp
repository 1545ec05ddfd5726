#include "planning/timed_follower.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/planning/timed_plan.hpp"

namespace viapoint::planning {
namespace {

constexpr double kShortestPiece = 1e-6;  ///< [s]
constexpr int kFewestPiecesAPart = 4;
constexpr int kMostNewtonSteps = 12;
/// The pose that Newton's iteration is content with [m, rad].
constexpr double kKnotError = 1e-11;
/// What J q̇ may differ from the wanted rate by, as a share of it: more is a direction the arm
/// lacks.
constexpr double kRateError = 1e-7;

struct Knot {
  double t = 0.0;
  JointVector q, qd, qdd;
};

TrajectoryPiece piece_of(const Knot& from, const Knot& to) {
  const double duration = to.t - from.t;
  const JointPiece curve =
      JointPiece::hermite({from.q, from.qd, from.qdd, {}}, {to.q, to.qd, to.qdd, {}}, duration);
  TrajectoryPiece piece;
  piece.duration = duration;
  piece.joints = static_cast<std::int32_t>(from.q.size());
  piece.timing[1] = 1.0;
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < piece.joints; ++i) {
      piece.path[static_cast<size_t>(k)][static_cast<size_t>(i)] = curve.coefficients(k, i);
    }
  }
  return piece;
}

class Follower {
 public:
  Follower(const RobotModel& robot, const DriveMotion& motion, bool oriented)
      : robot_(robot), arm_(robot.forward()), motion_(motion), rows_(oriented ? 6 : 3) {}

  TimedPieces run(const JointVector& first) {
    JointVector q = first;
    for (size_t part = 0; part < motion_.parts(); ++part) q = follow_part(part, q);
    return std::move(result_);
  }

 private:
  JointVector follow_part(size_t part, const JointVector& q) {
    const double end = motion_.end_of(part);
    const std::optional<Knot> begin = rates_at(part, motion_.start_of(part), q);
    if (!begin) refuse(part, motion_.start_of(part), q);
    Knot from = *begin;
    const double longest = (end - from.t) / kFewestPiecesAPart;
    double step = longest;
    while (from.t < end) {
      // The last piece takes what would be left over as a sliver.
      const double to = end - from.t <= 1.01 * step ? end : from.t + step;
      if (const std::optional<Knot> next = next_knot(part, from, to)) {
        result_.pieces.push_back(piece_of(from, *next));
        from = *next;
        step = std::min(longest, 2.0 * step);
      } else {
        step *= 0.5;
        if (step < kShortestPiece) refuse(part, to, from.q);
      }
    }
    return from.q;
  }

  /// The knot at `to`, unless the piece up to it strays from the motion.
  std::optional<Knot> next_knot(size_t part, const Knot& from, double to) {
    const double h = to - from.t;
    JointVector q = from.q + h * (from.qd + 0.5 * h * from.qdd);
    if (!solve(motion_.at(part, to).pose, q)) return std::nullopt;
    std::optional<Knot> knot = rates_at(part, to, q);
    if (!knot) return std::nullopt;
    const TrajectoryPiece piece = piece_of(from, *knot);
    double position = 0.0, angle = 0.0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const Pose wanted = motion_.at(part, from.t + share * h).pose;
      const Twist error = error_to(wanted, arm_.pose(piece.at(share * h).q));
      position = std::max(position, error.head<3>().norm());
      angle = std::max(angle, error.tail<3>().norm());
    }
    // Written so that NaN is no piece.
    if (!(position <= kTimedPoseError && angle <= kTimedPoseError)) return std::nullopt;
    result_.position_error = std::max(result_.position_error, position);
    result_.angle_error = std::max(result_.angle_error, angle);
    return knot;
  }

  Twist error_to(const Pose& wanted, const Pose& is) const {
    Twist error = Twist::Zero();
    error.head<3>() = wanted.translation() - is.translation();
    if (rows_ == 6) error.tail<3>() = rotation_log(wanted.linear() * is.linear().transpose());
    return error;
  }

  /// Least-squares, least-norm answer: exact for six joints away from singularities.
  JointVector solved(const Jacobian& jacobian, const Twist& right) const {
    return jacobian.topRows(rows_).completeOrthogonalDecomposition().solve(right.head(rows_));
  }

  bool solve(const Pose& wanted, JointVector& q) const {
    for (int i = 0; i < kMostNewtonSteps; ++i) {
      const ChainFrames frames = arm_.frames(q);
      const Twist error = error_to(wanted, frames.pose_base_tool);
      if (error.norm() <= kKnotError) return true;
      q += solved(arm_.jacobian(frames), error);
      if (!q.allFinite()) return false;
    }
    return error_to(wanted, arm_.pose(q)).norm() <= kKnotError;
  }

  /// Rates that give the tool its rates at t; nothing where the arm lacks a direction for them.
  std::optional<Knot> rates_at(size_t part, double t, const JointVector& q) const {
    const ToolState tool = motion_.at(part, t);
    const ChainFrames frames = arm_.frames(q);
    const Jacobian jacobian = arm_.jacobian(frames);
    Twist rate, rate_change;
    rate << tool.velocity, tool.angular_velocity;
    rate_change << tool.acceleration, tool.angular_acceleration;
    const auto reached = [&](const JointVector& x, const Twist& wanted) {
      const double missed = (jacobian.topRows(rows_) * x - wanted.head(rows_)).norm();
      return missed <= kRateError * (1.0 + wanted.head(rows_).norm());
    };
    Knot knot{t, q, solved(jacobian, rate), {}};
    if (!reached(knot.qd, rate)) return std::nullopt;
    const Twist right = rate_change - arm_.jacobian_rate(frames, knot.qd) * knot.qd;
    knot.qdd = solved(jacobian, right);
    if (!reached(knot.qdd, right)) return std::nullopt;
    return knot;
  }

  [[noreturn]] void refuse(size_t part, double t, const JointVector& near) const {
    char at[32];
    std::snprintf(at, sizeof at, "%.6g", t);
    Problem problem;
    problem.time = t;
    if (robot_.joints() < rows_) {
      problem.code = ErrorCode::kUncontrolled;
      problem.message = robot_.name() + " has " + std::to_string(robot_.joints()) +
                        " joints and cannot hold all " + std::to_string(rows_) +
                        " coordinates of the motion at " + at + " s";
      problem.ways_out = {"give tool positions alone", "use space=\"joint\""};
      throw MotionError(std::move(problem));
    }
    if (rows_ == 6) {
      try {
        static_cast<void>(robot_.inverse().solve_near_unlimited(motion_.at(part, t).pose, near));
      } catch (const MotionError& error) {
        problem = error.problem();
        problem.message = "at " + std::string(at) + " s: " + problem.message;
        problem.time = t;
        throw MotionError(std::move(problem));
      }
    }
    problem.code = ErrorCode::kSingular;
    problem.message = "at " + std::string(at) +
                      " s the motion meets a singularity of the arm that its joints can pass at no "
                      "speed";
    problem.ways_out = {"use space=\"joint\"",
                        "move the points so that the tool keeps clear of it"};
    throw MotionError(std::move(problem));
  }

  const RobotModel& robot_;
  const ForwardKinematics& arm_;
  const DriveMotion& motion_;
  const int rows_;
  TimedPieces result_;
};

}  // namespace

TimedPieces follow(const RobotModel& robot, const DriveMotion& motion, const JointVector& first,
                   bool oriented) {
  return Follower(robot, motion, oriented).run(first);
}

}  // namespace viapoint::planning
