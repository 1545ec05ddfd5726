/// @file
/// A section of path as the timing sees it: every piece in a parameter σ of its own, about as long
/// as the joints' way, with the limits by σ. What scale of s the pieces came in does not matter.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/path/joint_path.hpp"
#include "viapoint/path/tool_rates.hpp"

namespace viapoint::path_timing {

/// Largest shares of the limits, as bounds.
struct Shares {
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;

  void include(const Shares& other);
  /// The factor on time that makes the largest share one.
  [[nodiscard]] double stretch() const;
};

/// The most that |d^n q_i / dσ^n| may be multiplied with, as shares of the limits: a joint's first
/// derivative over its velocity limit, the first two over its acceleration limit, all three over
/// its jerk limit. Joints beyond those of the arm are zero.
struct JointRates {
  std::array<double, kMaxJoints> velocity{};
  std::array<double, kMaxJoints> acceleration1{}, acceleration2{};
  std::array<double, kMaxJoints> jerk1{}, jerk2{}, jerk3{};
};

/// One path piece in its own σ.
struct Stretch {
  const JointPiece* geometry = nullptr;
  const ToolRates* tool = nullptr;  ///< where the piece limits the tool
  double length = 0.0;              ///< of σ
  double gear = 1.0;                ///< σ̇ here over σ̇ of the piece before, where they meet
  bool straight = false;
  /// What the joints' limits allow of σ̇, |σ̈| and |σ⃛| on a straight piece; on others not used.
  double rate_limit = 0.0, change_limit = 0.0, jerk_limit = 0.0;
};

/// A section, from rest to rest. Path and tool rates must outlive it.
class Course {
 public:
  /// @param tool one a piece of the path, or none
  Course(const JointPath& path, const JointLimits& limits, std::span<const ToolRates> tool = {});

  [[nodiscard]] int joints() const { return joints_; }
  [[nodiscard]] const std::vector<Stretch>& stretches() const { return stretches_; }
  [[nodiscard]] bool limits_tool() const {
    return std::any_of(stretches_.begin(), stretches_.end(),
                       [](const Stretch& stretch) { return stretch.tool != nullptr; });
  }
  [[nodiscard]] bool holds_speed() const {
    return std::any_of(stretches_.begin(), stretches_.end(), [](const Stretch& stretch) {
      return stretch.tool != nullptr && stretch.tool->limits.hold_speed;
    });
  }
  /// One over the limits of a joint along a stretch.
  [[nodiscard]] Shares shares_per_rate(size_t stretch, int joint) const {
    const double per_scale = 1.0 / stretches_[stretch].geometry->scale;
    return {per_velocity_[joint] * per_scale, per_acceleration_[joint] * per_scale,
            per_jerk_[joint] * per_scale};
  }
  /// The path with one scale of s all along: s is σ of the first piece.
  [[nodiscard]] JointPath in_one_scale() const;
  /// Derivatives by σ at a place, as shares of the limits.
  void rates(size_t stretch, double sigma, JointRates& rates) const;

 private:
  int joints_;
  JointVector per_velocity_, per_acceleration_, per_jerk_;  ///< one over the limits
  std::vector<Stretch> stretches_;
};

}  // namespace viapoint::path_timing
