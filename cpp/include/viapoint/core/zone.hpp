/// @file
#pragma once

#include <limits>

namespace viapoint {

/// How near a move must pass its point.
enum class ZoneKind {
  kFine,            ///< stop there
  kRadius,          ///< leave the legs at most `size` m from the point, at the tool
  kDeviation,       ///< path and legs at most `size` m apart, both ways, at the tool
  kJointDeviation,  ///< the same over all joints, 2-norm [rad]
};
struct Zone {
  ZoneKind kind = ZoneKind::kFine;
  double size = 0.0;
  /// Bound of the tool's orientation besides [rad]: from that at the point for kRadius, else from
  /// that of the legs, both ways.
  double angle = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool bounds_angle() const {
    return angle < std::numeric_limits<double>::infinity();
  }
  bool operator==(const Zone&) const = default;
};

}  // namespace viapoint
