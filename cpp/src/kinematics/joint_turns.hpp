/// @file
/// One branch of an inverse is an angle modulo 2π a joint: which whole turns lie within the limits,
/// and which of them is nearest.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// How far a branch leaves the limits: the joint that is worst on its best turn.
struct LimitExcess {
  int joint = -1;       ///< -1: a coupled limit, `row`
  int row = -1;         ///< coupled limit
  double value = 0.0;   ///< [rad or m]
  double limit = 0.0;   ///< [rad or m]
  double excess = 0.0;  ///< [rad or m]
};

/// True when `a` is nearer to `reference` than `b`: the largest joint change decides, then the sum
/// of squares.
[[nodiscard]] bool is_nearer(const JointVector& a, const JointVector& b,
                             const JointVector& reference);

/// `angle` moved by whole turns to within π of `reference` [rad].
[[nodiscard]] double wrap_near(double angle, double reference);

/// Immutable. Threads: any.
class JointTurns {
 public:
  JointTurns(const ForwardKinematics& forward, const JointLimits& limits);

  /// The turn of `branch` nearest to `reference` that keeps every limit. A joint outside by no more
  /// than rounding at a singular pose is set on its limit: check the result by its pose.
  /// @param moved set when that was done: else the result is `branch` but for whole turns
  [[nodiscard]] std::optional<JointVector> nearest(const JointVector& branch,
                                                   const JointVector& reference,
                                                   bool* moved = nullptr) const;
  /// The same in place; false, with q of no use, where no turn keeps the limits. Real-time: safe.
  [[nodiscard]] bool bring_near(JointVector& q, const JointVector& reference, bool* moved) const;
  /// Every turn of `branch` within the limits (of joints without limits: the one nearest to
  /// `reference`).
  [[nodiscard]] std::vector<JointVector> all(const JointVector& branch,
                                             const JointVector& reference) const;
  /// The turn nearest to `reference`, limits left aside.
  [[nodiscard]] JointVector unlimited(const JointVector& branch,
                                      const JointVector& reference) const;
  /// A lower bound of the change of one joint from `reference` to a turn of `angle` within its
  /// limits [rad or m]; infinite where there is none. Real-time: safe.
  [[nodiscard]] double least_change(int joint, double angle, double reference) const;
  /// @pre no turn of `branch` keeps the limits
  [[nodiscard]] LimitExcess excess(const JointVector& branch) const;

 private:
  /// The turns of one joint within its limits: base + 2π k for `count` k from `begin` on.
  struct Range {
    double base = 0.0;
    int begin = 0;
    int count = 0;
  };
  [[nodiscard]] Range range(int joint, double angle, double reference) const;
  /// Calls visit(q) for every turn of `branch` within all limits. Allocates nothing itself.
  template <typename Visit>
  void each(const JointVector& branch, const JointVector& reference, Visit&& visit) const;
  /// q by whole turns to within π of `reference`.
  void wrap(JointVector& q, const JointVector& reference) const;
  /// One turn brings most joints inside or shows that none does.
  enum class OneTurn { kInside, kRefused, kOpen };
  /// Moves q only where it brings every joint inside. @tparam Count of joints, 0 for any
  template <int Count>
  [[nodiscard]] OneTurn try_one_turn(JointVector& q, const JointVector& reference) const;
  /// @pre wrapped; the same by the turns that bring it within the limits, joint by joint
  [[nodiscard]] bool shift_inside(JointVector& q, bool* moved) const;
  [[nodiscard]] bool coupled(const JointVector& q) const;

  int joints_;
  std::array<double, kMaxJoints> turn_{};      ///< 2π, or 0 for joints that slide
  std::array<double, kMaxJoints> per_turn_{};  ///< 1/2π, or 0
  std::array<double, kMaxJoints> low_{};       ///< the limits
  std::array<double, kMaxJoints> high_{};
  std::array<double, kMaxJoints> lowest_{};  ///< the limits, and what is still set on them
  std::array<double, kMaxJoints> highest_{};
  std::array<JointType, kMaxJoints> types_{};
  JointLimits limits_;
};

}  // namespace viapoint
