#include "rtde/arm_view.hpp"

#include <algorithm>

namespace viapoint::rtde {
namespace {

/// Without a cycle for so long the loop does none any more [ns].
constexpr std::int64_t kSilence = 200'000'000;
/// Positions farther apart than so many cycles tell no velocity.
constexpr std::uint64_t kMostCyclesApart = 50;
constexpr double kNano = 1e-9;

Vector6 place_of(const Pose& pose) {
  const Eigen::AngleAxisd turn(pose.rotation());
  Vector6 place;
  place << pose.translation(), turn.angle() * turn.axis();
  return place;
}

}  // namespace

bool ArmWatch::is_alive(const LoopCycle& cycle, std::int64_t now) {
  return now - cycle.stamp < kSilence;
}

ArmView ArmWatch::see(const LoopCycle& cycle, std::int64_t now) {
  ArmView view;
  const bool is_alive_now = is_alive(cycle, now);
  view.cycle = cycle;
  view.has_power = is_alive_now || cycle.state == RunState::kFault;
  const std::int64_t since = (is_alive_now ? cycle.stamp : now) - begin_;
  view.time = kNano * static_cast<double>(std::max(since, std::int64_t{0}));
  // The drive tells positions only; a loop that was built anew counts from the beginning again.
  const std::uint64_t apart = cycle.cycle - last_.cycle;
  if (cycle.cycle > last_.cycle && apart <= kMostCyclesApart && last_.q.size() == kAxes) {
    view.actual_qd =
        (cycle.measurement.q - last_.measurement.q) / (cycle_ * static_cast<double>(apart));
  }
  last_ = cycle;
  if (!is_alive_now) {
    view.cycle.qd.setZero();
    view.cycle.qdd.setZero();
    view.cycle.rate = 0.0;
  }
  const ChainFrames target = kinematics_.frames(cycle.q);
  const ChainFrames actual = kinematics_.frames(cycle.measurement.q);
  view.target_tool = place_of(target.pose_base_tool);
  view.actual_tool = place_of(actual.pose_base_tool);
  view.target_tool_speed = kinematics_.jacobian(target) * view.cycle.qd;
  view.actual_tool_speed = kinematics_.jacobian(actual) * view.actual_qd;
  return view;
}

}  // namespace viapoint::rtde
