/// @file
/// How a path is run so that the tool keeps its speed, and which joint wants it slower.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/joint_state.hpp"
#include "viapoint/path/tool_rates.hpp"

namespace viapoint::planning {

/// Value, slope and bend of Σ c_k u^k.
[[nodiscard]] std::array<double, 3> value_slope_bend(const std::array<double, 6>& c, double u);

/// A rate of the tool at one u, with two derivatives by u.
struct RateAt {
  Eigen::Vector3d value, slope, bend;
};

[[nodiscard]] RateAt rate_at(const ToolRate& rate, double u);

/// u and its derivatives by time.
struct Pace {
  double u = 0.0, rate = 0.0, change = 0.0, jerk = 0.0;
};

/// The pace at u that keeps the tool's speed: u̇² = v² / f with f = ‖p_u‖², so ü = -v² f' / 2f² and
/// u⃛ = u̇ dü/du. No pace at all where the tool's point rests.
[[nodiscard]] Pace pace_at_speed(const RateAt& linear, double u, double speed);

/// A limit, and how many times slower it wants the motion to be.
struct Ruling {
  double slower = 0.0;
  std::string limit;
  std::optional<int> joint;

  /// Takes the limit over if it wants the motion slower than the one so far.
  /// @param share of the limit that is used
  /// @param order of the derivative by time that it limits: the share goes by that power of the
  ///        speed
  void take(double share, int order, const char* name, std::optional<int> of = std::nullopt);
  /// The same of all joints of a state. @param share of the limits that may be used
  void take(const JointLimits& limits, double share, const JointState& state);
};

}  // namespace viapoint::planning
