/// @file
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "kinematics/joint_turns.hpp"

namespace viapoint {

/// What a branch has to keep to be of use: every joint on a turn within its limits, and the squares
/// of all changes from a reference below a bound. A form that has found some of a branch's joints
/// can leave the others where these break it already. Threads: any. Real-time: safe.
class JointSieve {
 public:
  /// Lets every branch pass.
  JointSieve() = default;
  /// @pre `turns` and `reference` outlive the sieve @param most of the sum of squares [rad² or m²]
  JointSieve(const JointTurns& turns, const JointVector& reference, double most)
      : turns_(&turns), reference_(&reference), most_(most) {}

  /// The square of the least change that brings `joint` to `value` within its limits; infinite
  /// where no turn does.
  [[nodiscard]] double square(int joint, double value) const {
    if (turns_ == nullptr) return 0.0;
    const double change = turns_->least_change(joint, value, (*reference_)[joint]);
    return change * change;
  }
  /// The sum of those of the joints from `first` on.
  template <std::size_t Count>
  [[nodiscard]] double squares(int first, const std::array<double, Count>& values) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < Count; ++i) sum += square(first + static_cast<int>(i), values[i]);
    return sum;
  }
  /// @param sum of the squares of some joints
  [[nodiscard]] bool passes(double sum) const { return sum <= most_; }

 private:
  const JointTurns* turns_ = nullptr;
  const JointVector* reference_ = nullptr;
  double most_ = std::numeric_limits<double>::max();
};

}  // namespace viapoint
