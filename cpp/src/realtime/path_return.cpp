#include "viapoint/realtime/path_return.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {
namespace {

/// A joint that moves by less than this [rad or m] stands still, as far as limits go.
constexpr double kNoStep = 1e-12;
/// Slower than this share of the limits would take hours: what is above 0 counts as this much.
constexpr double kLeastShare = 1e-4;
/// Of the way back: what is beyond its end by rounding.
constexpr double kBeyond = 1e-9;

}  // namespace

PathReturn::PathReturn(const JointLimits& limits, double cycle) : limits_(limits), cycle_(cycle) {
  law_.begin({});
}

void PathReturn::begin(const JointVector& from,
                       const JointVector& to) noexcept VIAPOINT_NONBLOCKING {
  from_ = from;
  to_ = to;
  step_ = to - from;
  velocity_ = acceleration_ = jerk_ = 0.0;
  bool is_any = false;
  for (int i = 0; i < limits_.joints(); ++i) {
    const double size = std::abs(step_[i]);
    if (size < kNoStep) continue;
    const double v = limits_.velocity[i] / size, a = limits_.acceleration[i] / size;
    const double j = limits_.jerk[i] / size;
    velocity_ = is_any ? std::min(velocity_, v) : v;
    acceleration_ = is_any ? std::min(acceleration_, a) : a;
    jerk_ = is_any ? std::min(jerk_, j) : j;
    is_any = true;
  }
  law_.begin({is_any ? 0.0 : 1.0, 0.0, 0.0, 0.0});
  cycles_ = 0;
  share_ = 0.0;
  active_ = true;
  arrived_ = false;
  rests_ = true;
}

void PathReturn::replan(const AxisState& from, double share) noexcept VIAPOINT_NONBLOCKING {
  AxisMove law;
  MoveStatus status = MoveStatus::kBadLimits;
  const AxisLimits limits = AxisLimits::symmetric(velocity_, acceleration_, jerk_);
  if (share > 0.0 && from.q < 1.0) {
    AxisLimits slower = limits;
    slower.velocity_max = share * velocity_;
    status = quickest_move(from, {1.0, 0.0, 0.0, 0.0}, slower, law);
    if (status == MoveStatus::kSolved && law.extent().high > 1.0 + kBeyond) {
      // Too near to slow down first: it would come out beyond the path and turn back.
      slower.velocity_max = std::max(slower.velocity_max, from.qd);
      status = quickest_move(from, {1.0, 0.0, 0.0, 0.0}, slower, law);
    }
  }
  if (status != MoveStatus::kSolved) status = quickest_velocity_change(from, {}, limits, law);
  if (status != MoveStatus::kSolved) return;
  law_ = law;
  cycles_ = 0;
}

void PathReturn::tick(double share, Setpoint& setpoint) noexcept VIAPOINT_NONBLOCKING {
  const auto state_now = [this] {
    const double t = static_cast<double>(cycles_) * cycle_;
    return t >= law_.total ? AxisState{law_.end.q, 0.0, 0.0, 0.0} : law_.at(t);
  };
  AxisState s = state_now();
  const double wanted = share > 0.0 ? std::max(share, kLeastShare) : 0.0;
  if (wanted != share_) {
    replan(s, wanted);
    share_ = wanted;
    s = state_now();
  }
  rests_ = s.qd == 0.0 && s.qdd == 0.0 && static_cast<double>(cycles_) * cycle_ >= law_.total;
  arrived_ = rests_ && s.q >= 1.0;
  setpoint.q = arrived_ ? to_ : JointVector(from_ + s.q * step_);
  setpoint.qd = step_ * s.qd;
  setpoint.qdd = step_ * s.qdd;
  setpoint.qddd = step_ * s.qddd;
  ++cycles_;
}

}  // namespace viapoint
