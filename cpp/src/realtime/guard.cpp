#include "viapoint/realtime/guard.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/number_text.hpp"

namespace viapoint {
namespace {

/// Relative slack, and step of a rate between two pieces as a share of its limit: the
/// certificate's.
constexpr double kSlack = 1e-6;
/// Position by which a motion may begin beside where the arm rests, as it is admitted [rad or m].
constexpr double kStartTolerance = 2e-6;

/// False for what is not a number, too.
bool is_within(double value, double limit) noexcept {
  return std::abs(value) <= limit * (1.0 + kSlack);
}

/// Relative slack of what a state leads to: rates within their own slack make it a few times that.
constexpr double kForesight = 4e-6;

/// The velocity that no jerk within its limit can keep a joint from reaching: v + a|a|/(2 J).
double peak_velocity(double velocity, double acceleration, double jerk) noexcept {
  return velocity + 0.5 * acceleration * std::abs(acceleration) / jerk;
}

/// How far a joint goes on, whatever it does within its limits: the braking of the quickest rest,
/// a(t) = max(a - J t, -A), until its velocity is zero. Signed as the velocity.
double least_excursion(double velocity, double acceleration, double most_acceleration,
                       double jerk) noexcept {
  const double v = std::abs(velocity);
  const double a = velocity < 0.0 ? -acceleration : acceleration;
  const double A = most_acceleration, J = jerk;
  const double until_zero = (a + std::sqrt(a * a + 2.0 * J * v)) / J;
  const double until_most = (a + A) / J;
  const double t = std::max(std::min(until_zero, until_most), 0.0);
  const double left = std::max(v + t * (a - 0.5 * J * t), 0.0);
  const double way = t * (v + t * (0.5 * a - J * t / 6.0)) + 0.5 * left * left / A;
  return std::copysign(way, velocity);
}

/// An encoder tells a step larger than its joint can make, and than its own noise [rad or m].
constexpr double kEncoderNoise = 1e-3;
constexpr double kEncoderSpeeds = 2.0;

}  // namespace

Guard::Guard(const JointLimits& limits, std::chrono::nanoseconds cycle, const GuardOptions& options,
             const JointVector& start)
    : limits_(limits),
      cycle_(std::chrono::duration<double>(cycle).count()),
      options_(options),
      holds_tool_(options.kinematics.has_value() &&
                  (std::isfinite(options.tool_speed) || !options.box_min.array().isInf().all() ||
                   !options.box_max.array().isInf().all())),
      q_(start),
      qd_(JointVector::Zero(start.size())),
      qdd_(JointVector::Zero(start.size())),
      measured_(start) {
  for (AxisMove& move : stop_) move.begin({});
  if (holds_tool_) tool_ = options_.kinematics->pose(q_).translation();
}

Guard::Verdict Guard::pass(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  if (!off_path_) {
    const Breach breach = judge(setpoint);
    if (breach.any()) {
      if (!breach_.any()) breach_ = breach;
      begin_stop();
    }
  }
  if (off_path_) return tell_stop(setpoint) ? Verdict::kAtRest : Verdict::kOffPath;
  if (holds_tool_) {
    const Breach breach = judge_tool(setpoint);
    if (!breach_.any()) breach_ = breach;
  }
  q_ = setpoint.q;
  qd_ = setpoint.qd;
  qdd_ = setpoint.qdd;
  return breach_.any() ? Verdict::kStopOnPath : Verdict::kPass;
}

Breach Guard::judge(const Setpoint& next) const noexcept VIAPOINT_NONBLOCKING {
  using Kind = Breach::Kind;
  const int joints = limits_.joints();
  for (const JointVector* vector : {&next.q, &next.qd, &next.qdd, &next.qddd}) {
    if (vector->size() != joints) return {Kind::kNotFinite, -1, 0.0, 0.0};
    for (int i = 0; i < joints; ++i) {
      if (!std::isfinite((*vector)[i])) return {Kind::kNotFinite, i, (*vector)[i], 0.0};
    }
  }
  for (int i = 0; i < joints; ++i) {
    const double least = limits_.position_min[i], most = limits_.position_max[i];
    const double v = limits_.velocity[i], a = limits_.acceleration[i], j = limits_.jerk[i];
    const double step = next.q[i] - q_[i];
    if (next.q[i] > most + kStartTolerance && step > 0.0) {
      return {Kind::kPosition, i, next.q[i], most};
    }
    if (next.q[i] < least - kStartTolerance && step < 0.0) {
      return {Kind::kPosition, i, next.q[i], least};
    }
    const double mean = step / cycle_;
    if (!is_within(std::max(std::abs(mean) - kStartTolerance / cycle_, 0.0), v)) {
      return {Kind::kVelocity, i, mean, v};
    }
    if (!is_within(next.qd[i], v)) return {Kind::kVelocity, i, next.qd[i], v};
    const double acceleration = (next.qd[i] - qd_[i]) / cycle_;
    if (!is_within(acceleration, a + kSlack * v / cycle_))
      return {Kind::kAcceleration, i, acceleration, a};
    if (!is_within(next.qdd[i], a)) return {Kind::kAcceleration, i, next.qdd[i], a};
    const double jerk = (next.qdd[i] - qdd_[i]) / cycle_;
    if (!is_within(jerk, j + kSlack * a / cycle_)) return {Kind::kJerk, i, jerk, j};
    if (!is_within(next.qddd[i], j)) return {Kind::kJerk, i, next.qddd[i], j};
    // What no motion within the limits can do any more is seen while the joint can still stop.
    const double peak = peak_velocity(next.qd[i], next.qdd[i], j);
    if (!is_within(peak, v + kForesight * v)) return {Kind::kVelocity, i, peak, v};
    const double reach =
        next.q[i] + (1.0 - kForesight) * least_excursion(next.qd[i], next.qdd[i], a, j);
    if (reach > most + kStartTolerance && next.qd[i] > 0.0 && step > 0.0) {
      return {Kind::kPosition, i, reach, most};
    }
    if (reach < least - kStartTolerance && next.qd[i] < 0.0 && step < 0.0) {
      return {Kind::kPosition, i, reach, least};
    }
    const double beside = step - 0.5 * cycle_ * (next.qd[i] + qd_[i]);
    const double allowed = cycle_ * cycle_ * cycle_ * j / 12.0 + kStartTolerance;
    if (!is_within(beside, allowed)) return {Kind::kDerivatives, i, beside, allowed};
  }
  return judge_couplings(next);
}

Breach Guard::judge_couplings(const Setpoint& next) const noexcept VIAPOINT_NONBLOCKING {
  for (int row = 0; row < limits_.couplings(); ++row) {
    double value = 0.0, step = 0.0, weight = 1.0;
    for (int i = 0; i < limits_.joints(); ++i) {
      const double factor = limits_.coupling(row, i);
      value += factor * next.q[i];
      step += factor * (next.q[i] - q_[i]);
      weight += std::abs(factor);
    }
    const double slack = weight * kStartTolerance, rounding = kSlack * slack;
    const double least = limits_.coupling_lower[row], most = limits_.coupling_upper[row];
    if (value > most + slack && step > rounding) return {Breach::Kind::kCoupling, row, value, most};
    if (value < least - slack && step < -rounding)
      return {Breach::Kind::kCoupling, row, value, least};
  }
  return {};
}

Breach Guard::judge_tool(const Setpoint& next) noexcept VIAPOINT_NONBLOCKING {
  const Eigen::Vector3d before = tool_;
  tool_ = options_.kinematics->pose(next.q).translation();
  for (int axis = 0; axis < 3; ++axis) {
    const double least = options_.box_min[axis], most = options_.box_max[axis];
    if (!(tool_[axis] <= most) && tool_[axis] > before[axis]) {
      return {Breach::Kind::kBox, axis, tool_[axis], most};
    }
    if (!(tool_[axis] >= least) && tool_[axis] < before[axis]) {
      return {Breach::Kind::kBox, axis, tool_[axis], least};
    }
  }
  const double speed = (tool_ - before).norm() / cycle_;
  if (is_within(speed, options_.tool_speed)) return {};
  return {Breach::Kind::kToolSpeed, -1, speed, options_.tool_speed};
}

void Guard::look_at(DriveStatus status, const Measurement& measurement,
                    std::int64_t late_cycles) noexcept VIAPOINT_NONBLOCKING {
  using Kind = Breach::Kind;
  const auto note = [this](const Breach& breach) {
    if (!breach_.any()) breach_ = breach;
  };
  if (status == DriveStatus::kFault) return note({Kind::kDrive, -1, 0.0, 0.0});
  if (status == DriveStatus::kPowerLost) return note({Kind::kPowerLost, -1, 0.0, 0.0});
  unseen_cycles_ += 1.0 + static_cast<double>(late_cycles);
  if (status == DriveStatus::kSilent) {
    if (++silent_ > options_.silent_cycles) {
      note({Kind::kSilent, -1, static_cast<double>(silent_),
            static_cast<double>(options_.silent_cycles)});
    }
    return;
  }
  const int joints = std::min(limits_.joints(), static_cast<int>(measurement.q.size()));
  const double time = unseen_cycles_ * cycle_;
  for (int i = 0; i < joints; ++i) {
    const double step = measurement.q[i] - measured_[i], v = limits_.velocity[i];
    const double most = kEncoderSpeeds * v * time + kEncoderNoise;
    if (!is_within(step, most)) {
      note({Kind::kEncoder, i, step, most});
      break;
    }
    if (status == DriveStatus::kGuided) continue;
    const double behind = measurement.q[i] - q_[i];
    const double allowed = v * options_.following + kEncoderNoise;
    if (!is_within(behind, allowed)) {
      note({Kind::kFollowing, i, behind, allowed});
      break;
    }
  }
  silent_ = 0;
  unseen_cycles_ = 0.0;
  measured_ = measurement.q;
}

void Guard::stand_at(const JointVector& position) noexcept VIAPOINT_NONBLOCKING {
  q_ = position;
  qd_.setZero();
  qdd_.setZero();
  if (holds_tool_) tool_ = options_.kinematics->pose(q_).translation();
}

void Guard::refuse_hand() noexcept VIAPOINT_NONBLOCKING {
  if (!breach_.any()) breach_ = {Breach::Kind::kGuided, -1, 0.0, 0.0};
}

void Guard::begin_stop() noexcept VIAPOINT_NONBLOCKING {
  off_path_ = true;
  stopping_ = 0;
  for (int i = 0; i < limits_.joints(); ++i) {
    AxisMove& move = stop_[static_cast<std::size_t>(i)];
    const AxisState from{q_[i], qd_[i], qdd_[i], 0.0};
    const AxisLimits limits =
        AxisLimits::symmetric(limits_.velocity[i], limits_.acceleration[i], limits_.jerk[i]);
    // A finite start, which it is, has a stop always; else the joint is told to stay.
    if (quickest_velocity_change(from, {}, limits, move) != MoveStatus::kSolved) move.begin(from);
  }
}

bool Guard::tell_stop(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  const int joints = limits_.joints();
  setpoint.q.resize(joints);
  setpoint.qd.resize(joints);
  setpoint.qdd.resize(joints);
  setpoint.qddd.resize(joints);
  const double t = static_cast<double>(++stopping_) * cycle_;
  bool rests = true;
  for (int i = 0; i < joints; ++i) {
    const AxisMove& move = stop_[static_cast<std::size_t>(i)];
    const bool is_over = t >= move.total;
    const AxisState state = is_over ? AxisState{move.end.q, 0.0, 0.0, 0.0} : move.at(t);
    setpoint.q[i] = state.q;
    setpoint.qd[i] = state.qd;
    setpoint.qdd[i] = state.qdd;
    setpoint.qddd[i] = state.qddd;
    rests = rests && is_over;
  }
  q_ = setpoint.q;
  return rests;
}

std::string text_of(const Breach& breach) {
  using Kind = Breach::Kind;
  const std::string joint = "joint " + std::to_string(breach.index + 1);
  const std::string pair =
      " (" + number_text(breach.value) + "; the limit is " + number_text(breach.limit) + ")";
  switch (breach.kind) {
    case Kind::kNone:
      return {};
    case Kind::kNotFinite:
      return "a setpoint is not a number, or not one for each joint";
    case Kind::kPosition:
      return joint + " was told to leave its position limits" + pair;
    case Kind::kCoupling:
      return "the joints were told to leave their coupled limit " +
             std::to_string(breach.index + 1) + pair;
    case Kind::kVelocity:
      return joint + " was told to move too fast" + pair;
    case Kind::kAcceleration:
      return joint + " was told to accelerate too much" + pair;
    case Kind::kJerk:
      return joint + " was told to change its acceleration too fast" + pair;
    case Kind::kDerivatives:
      return joint + " was told a velocity that does not belong to its positions" + pair;
    case Kind::kBox:
      return std::string("the tool left its box along ") + "xyz"[breach.index] + pair;
    case Kind::kToolSpeed:
      return "the tool was told to move too fast" + pair;
    case Kind::kFollowing:
      return joint + " is too far from its setpoint" + pair;
    case Kind::kEncoder:
      return joint + " was measured to jump" + pair;
    case Kind::kSilent:
      return "the drive has not answered for " + number_text(breach.value) + " cycles";
    case Kind::kGuided:
      return "a hand guided the arm while it was told to move";
    case Kind::kDrive:
      return "the drive reported a fault";
    case Kind::kPowerLost:
      return "the drive has lost its power (stop category 0)";
  }
  return {};
}

}  // namespace viapoint
