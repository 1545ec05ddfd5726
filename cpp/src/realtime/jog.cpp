#include "viapoint/realtime/jog.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {
namespace {

/// Wishes below this share of the velocity limit are none: they would take hours to be seen.
constexpr double kLeastShare = 1e-6;

}  // namespace

Jog::Jog(const JointLimits& limits, double cycle) : limits_(limits), cycle_(cycle) {
  for (Axis& axis : axes_) {
    axis.law.begin({});
    axis.cycles = 0;
    axis.wished = axis.followed = 0.0;
  }
  lower_ = limits.coupling_lower;
  upper_ = limits.coupling_upper;
}

AxisLimits Jog::limits_of(int joint) const noexcept VIAPOINT_NONBLOCKING {
  return AxisLimits::symmetric(limits_.velocity[joint], limits_.acceleration[joint],
                               limits_.jerk[joint]);
}

void Jog::wish(const JointVector& velocity, int cycles,
               const JointVector& position) noexcept VIAPOINT_NONBLOCKING {
  const int joints = limits_.joints();
  if (!active_) {
    for (int i = 0; i < joints; ++i) {
      Axis& axis = axes_[static_cast<std::size_t>(i)];
      axis.law.begin({position[i], 0.0, 0.0, 0.0});
      axis.cycles = 0;
      axis.wished = axis.followed = 0.0;
    }
    for (int row = 0; row < limits_.couplings(); ++row) {
      double sum = 0.0;
      for (int i = 0; i < joints; ++i) sum += limits_.coupling(row, i) * position[i];
      lower_[row] = std::min(limits_.coupling_lower[row], sum);
      upper_[row] = std::max(limits_.coupling_upper[row], sum);
    }
    is_stopped_ = false;
    block_ = {};
  }
  lease_ = cycles;
  bool is_other = false;
  bool is_any = false;
  for (int i = 0; i < joints; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double most = limits_.velocity[i];
    double wished = std::clamp(velocity[i], -most, most);
    if (!(std::abs(wished) >= kLeastShare * most)) wished = 0.0;
    const auto sign = [](double value) { return (value > 0.0) - (value < 0.0); };
    is_other = is_other || sign(wished) != sign(axis.wished);
    is_any = is_any || wished != 0.0;
    axis.wished = wished;
  }
  if (is_other) is_stopped_ = false;
  active_ = active_ || is_any;
}

AxisState Jog::state_of(const Axis& axis,
                        std::uint64_t cycles) const noexcept VIAPOINT_NONBLOCKING {
  const double t = static_cast<double>(cycles) * cycle_;
  return t > axis.law.total ? axis.law.after_end(t - axis.law.total) : axis.law.at(t);
}

void Jog::replan(int joint, bool stop) noexcept VIAPOINT_NONBLOCKING {
  Axis& axis = axes_[static_cast<std::size_t>(joint)];
  const AxisState from = state_of(axis, axis.cycles);
  const double wished = stop ? 0.0 : axis.wished;
  AxisLimits limits = limits_of(joint);
  limits.position_min = limits_.position_min[joint];
  limits.position_max = limits_.position_max[joint];
  const double wall = wished > 0.0 ? limits.position_max : limits.position_min;
  axis.followed = wished;
  axis.cycles = 0;
  AxisMove law;
  if (wished != 0.0 && std::isfinite(wall) && (wall - from.q) * wished > 0.0) {
    (wished > 0.0 ? limits.velocity_max : limits.velocity_min) = wished;
    if (quickest_move(from, {wall, 0.0, 0.0, 0.0}, limits, law) == MoveStatus::kSolved) {
      axis.law = law;
      return;
    }
  }
  // No position limit that way, or only outside of it: then rest. Neither can fail: any finite
  // start may be brought to a velocity within its limits.
  const double speed = std::isfinite(wall) ? 0.0 : wished;
  if (quickest_velocity_change(from, {0.0, speed, 0.0, 0.0}, limits, law) == MoveStatus::kSolved) {
    axis.law = law;
  }
}

void Jog::stop_all() noexcept VIAPOINT_NONBLOCKING {
  for (int i = 0; i < limits_.joints(); ++i) {
    if (axes_[static_cast<std::size_t>(i)].followed != 0.0) replan(i, true);
  }
}

/// Whether every coupled limit can still be kept after one more cycle: over the ranges of all
/// joints from now to the end of a stop begun then.
bool Jog::may_go_on() noexcept VIAPOINT_NONBLOCKING {
  const int joints = limits_.joints();
  std::array<double, kMaxJoints> low{}, high{};
  for (int i = 0; i < joints; ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    const AxisState now = state_of(axis, axis.cycles), next = state_of(axis, axis.cycles + 1);
    AxisMove stop;
    if (quickest_velocity_change(next, {}, limits_of(i), stop) != MoveStatus::kSolved) return false;
    const AxisMove::Extent extent = stop.extent();
    // Within the cycle a joint may turn: then it is farther out by a c²/8 at most.
    const double turn = now.qd * next.qd < 0.0 ? 0.125 * cycle_ * cycle_ *
                                                     std::max(std::abs(now.qdd), std::abs(next.qdd))
                                               : 0.0;
    const auto at = static_cast<std::size_t>(i);
    low[at] = std::min({now.q, next.q, extent.low}) - turn;
    high[at] = std::max({now.q, next.q, extent.high}) + turn;
  }
  for (int row = 0; row < limits_.couplings(); ++row) {
    double least = 0.0, most = 0.0;
    for (int i = 0; i < joints; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double factor = limits_.coupling(row, i);
      least += factor * (factor > 0.0 ? low[at] : high[at]);
      most += factor * (factor > 0.0 ? high[at] : low[at]);
    }
    if (!(most <= upper_[row] && least >= lower_[row])) {
      block_ = {JogBlock::Kind::kCouplingLimit, row};
      return false;
    }
  }
  return true;
}

void Jog::find_block() noexcept VIAPOINT_NONBLOCKING {
  if (is_stopped_) return;
  block_ = {};
  for (int i = 0; i < limits_.joints(); ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double rested = static_cast<double>(axis.cycles) * cycle_;
    if (axis.followed != 0.0 && axis.law.end.qd == 0.0 && rested >= axis.law.total) {
      block_ = {JogBlock::Kind::kPositionLimit, i};
      return;
    }
  }
}

void Jog::tick(Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  const int joints = limits_.joints();
  const bool is_wished = lease_ > 0;
  if (is_wished) --lease_;
  const bool stop = !is_wished || is_stopped_;
  for (int i = 0; i < joints; ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (axis.followed != (stop ? 0.0 : axis.wished)) replan(i, stop);
  }
  if (limits_.couplings() > 0 && !stop && !may_go_on()) {
    is_stopped_ = true;
    stop_all();
  }
  setpoint.q.resize(joints);
  setpoint.qd.resize(joints);
  setpoint.qdd.resize(joints);
  setpoint.qddd.resize(joints);
  bool rests = true;
  for (int i = 0; i < joints; ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    const AxisState state = state_of(axis, axis.cycles);
    setpoint.q[i] = state.q;
    setpoint.qd[i] = state.qd;
    setpoint.qdd[i] = state.qdd;
    setpoint.qddd[i] = state.qddd;
    const double t = static_cast<double>(axis.cycles) * cycle_;
    rests = rests && axis.followed == 0.0 && t >= axis.law.total;
    ++axis.cycles;
  }
  find_block();
  bool is_any = false;
  for (int i = 0; i < joints; ++i) {
    is_any = is_any || axes_[static_cast<std::size_t>(i)].wished != 0.0;
  }
  // While something is wished that cannot be, the jog stays: it holds the arm where it is.
  if (rests && !(is_wished && is_any)) active_ = false;
}

std::string text_of(const JogBlock& block) {
  const std::string index = std::to_string(block.index + 1);
  switch (block.kind) {
    case JogBlock::Kind::kNone:
      break;
    case JogBlock::Kind::kPositionLimit:
      return "joint " + index + " is at its position limit";
    case JogBlock::Kind::kCouplingLimit:
      return "the arm has stopped before its coupled limit " + index;
  }
  return {};
}

}  // namespace viapoint
