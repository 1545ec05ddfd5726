/// @file
/// What the output variables are made of.
#pragma once

#include <cstdint>

#include "viapoint/core/pose.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"
#include "viapoint/realtime/loop_cycle.hpp"

namespace viapoint::rtde {

inline constexpr int kAxes = 6;

using Vector6 = Eigen::Matrix<double, kAxes, 1>;

/// One cycle in RTDE's words, base frame.
struct ArmView {
  double time = 0.0;  ///< since the server began [s]
  LoopCycle cycle;
  bool has_power = true;
  Vector6 actual_qd = Vector6::Zero();  ///< [rad/s or m/s]
  /// Position [m] and rotation vector [rad].
  Vector6 target_tool = Vector6::Zero(), actual_tool = Vector6::Zero();
  Vector6 target_tool_speed = Vector6::Zero(), actual_tool_speed = Vector6::Zero();
};

/// Makes views out of cycles. Threads: one. Real-time: not.
class ArmWatch {
 public:
  /// @param cycle the loop's [s]; @param begin what `time` counts from [ns, CLOCK_MONOTONIC]
  ArmWatch(const ForwardKinematics& kinematics, double cycle, std::int64_t begin)
      : kinematics_(kinematics), cycle_(cycle), begin_(begin) {}

  /// The newest cycle as it stands at `now` [ns]. A loop that does no more cycles, after a fault or
  /// without power, stands still, and time goes on.
  [[nodiscard]] ArmView see(const LoopCycle& cycle, std::int64_t now);
  /// True while cycles come.
  [[nodiscard]] static bool is_alive(const LoopCycle& cycle, std::int64_t now);

 private:
  ForwardKinematics kinematics_;
  double cycle_;
  std::int64_t begin_;
  LoopCycle last_;
};

}  // namespace viapoint::rtde
